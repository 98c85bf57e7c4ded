// SPDX-License-Identifier: Apache-2.0
#include "versine/app/plan.hpp"

#include <fmt/format.h>

#include <chrono>

#include "versine/app/job_run.hpp"
#include "versine/app/report.hpp"
#include "versine/io/result_folder.hpp"
#include "versine/io/run_json.hpp"

namespace versine::app {

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

MonteCarloSetup monte_carlo_setup(const PlanConfig& c, int threads) {
  const auto& m = c.monte_carlo;
  MonteCarloSetup s{.plan = c.plan,
                    .simulated_gyro = c.plan.gyro,
                    .flicker = m.flicker,
                    .static_start = m.static_start,
                    .rate = m.imu_rate,
                    .runs = m.runs,
                    .seed = static_cast<std::uint64_t>(m.seed),
                    .threads = threads};
  s.simulated_gyro.bias = m.bias.value_or(s.simulated_gyro.bias);
  s.simulated_gyro.random_walk = m.random_walk.value_or(s.simulated_gyro.random_walk);
  s.simulated_gyro.bias_instability = m.bias_instability.value_or(s.simulated_gyro.bias_instability);
  s.simulated_gyro.rate_random_walk = m.rate_random_walk.value_or(s.simulated_gyro.rate_random_walk);
  return s;
}

void describe_defaults(ConfigVisitor& v) {
  PlanConfig defaults;
  describe(v, defaults);
}

Expected<std::vector<std::string>> check_plan(const std::filesystem::path& job,
                                              std::span<const std::string> overrides) {
  const auto c = read_plan_config(job, overrides);
  if (!c) return tl::unexpected(c.error());
  return std::vector<std::string>{
      fmt::format("plan: {} with a landmark every {} m at {:.2f} m/s, {} intervals", c->grade, c->plan.spacing,
                  c->plan.speed, c->plan.intervals),
      c->monte_carlo.runs > 0 ? fmt::format("{} simulated runs", c->monte_carlo.runs) : "no simulated runs"};
}

}  // namespace

const JobKind plan_job{"plan",
                       "Which accuracy follows from which sensors and which landmarks, before anything is bought.",
                       describe_defaults, check_plan};

Expected<PlanResult> compute_plan(const PlanConfig& c, int threads, Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  PlanResult r;
  r.derived = fusion::derive(c.plan);
  r.interval_worst = fusion::closed_form_worst(c.plan);
  r.chain = fusion::chain_accuracy(c.plan, c.chord);
  r.sigma = fusion::worst_sigma(c.plan, c.basis);
  r.met = r.sigma <= c.required;
  r.spacing = fusion::largest_spacing(c.plan, c.required, c.basis);
  r.random_walk = fusion::largest_random_walk(c.plan, c.required, c.basis);
  r.bias = fusion::largest_bias(c.plan, c.required, c.basis);
  r.grades = fusion::judge_grades(c.plan, c.required, c.basis);
  r.lateral = fusion::lateral_map(c.plan, c.map_bias, c.map_random_walk, c.map_points);
  r.vertical = fusion::vertical_map(c.plan, c.map_bias, c.map_random_walk, c.map_points);
  r.longitudinal = fusion::longitudinal_map(c.plan, c.map_scale, c.map_scale_walk, c.map_points);
  if (c.compare_methods) {
    for (const auto method : {fusion::PlanMethod::ins_landmark, fusion::PlanMethod::ins_odometer_landmark,
                              fusion::PlanMethod::landmark_reckoning}) {
      r.methods.push_back(fusion::method_accuracy(c.plan, method));
    }
  }
  r.planning_s = seconds_since(begin);
  if (c.monte_carlo.runs > 0) {
    const auto start = std::chrono::steady_clock::now();
    auto simulated = run_monte_carlo(monte_carlo_setup(c, threads), progress);
    if (!simulated) return tl::unexpected(simulated.error());
    r.monte_carlo = std::move(*simulated);
    r.monte_carlo_s = seconds_since(start);
  }
  return r;
}

Expected<PlanRun> run_plan(const std::filesystem::path& job, std::span<const std::string> overrides,
                           const std::filesystem::path& output, int monte_carlo, int threads, Progress& progress) {
  auto config = read_plan_config(job, overrides);
  if (!config) return tl::unexpected(config.error());
  if (auto done = check_report(config->report); !done) return tl::unexpected(done.error());
  if (monte_carlo >= 0) config->monte_carlo.runs = monte_carlo;
  io::Run run = begin_run("plan");
  auto folder = io::ResultFolder::create(result_target(job, output));
  if (!folder) return tl::unexpected(folder.error());
  const auto result = compute_plan(*config, threads, progress);
  if (!result) return tl::unexpected(result.error());
  if (auto done = write_plan_tables(folder->folder(), *config, *result); !done) return tl::unexpected(done.error());
  if (auto done = write_plan_figures(folder->folder(), *config, *result); !done) return tl::unexpected(done.error());

  run.time_scale = TimeScale::utc;
  if (auto input = io::describe_input("job", job.string(), job)) run.inputs.push_back(std::move(*input));
  run.settings_json = config_json([&](ConfigVisitor& v) { describe(v, *config); });
  run.results_json = plan_json(*config, *result);
  run.timings_s = {{"planning", result->planning_s}, {"Monte Carlo", result->monte_carlo_s}};
  if (auto done = io::write_run_json(folder->path("run.json"), run); !done) return tl::unexpected(done.error());
  if (auto done = write_job_report(config->report, folder->folder(), folder->target()); !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = folder->commit(); !done) return tl::unexpected(done.error());
  return PlanRun{folder->target(), run.results_json, plan_text(*config, *result), result->met};
}

}  // namespace versine::app
