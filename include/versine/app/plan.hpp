// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "versine/app/job_kinds.hpp"
#include "versine/app/plan_config.hpp"
#include "versine/app/plan_monte_carlo.hpp"
#include "versine/fusion/planning_methods.hpp"

/// `versine plan`: which accuracy follows from which sensors and which landmarks, before anything is bought.
namespace versine::app {

struct PlanResult {
  fusion::DerivedErrors derived;
  fusion::Directions interval_worst;  ///< one interval by itself
  fusion::ChainAccuracy chain;
  double sigma = 0.0;  ///< m, what is judged against the requirement
  bool met = false;
  std::optional<double> spacing, random_walk, bias;  ///< the reverse questions
  std::vector<fusion::GradeVerdict> grades;
  fusion::SigmaMap lateral, vertical, longitudinal;
  std::vector<fusion::MethodAccuracy> methods;
  std::optional<MonteCarloResult> monte_carlo;
  double planning_s = 0.0, monte_carlo_s = 0.0;
};

/// Computes everything that the job asks for; nothing is written.
[[nodiscard]] Expected<PlanResult> compute_plan(const PlanConfig& config, int threads, Progress& progress);

/// Table for a person, and the same as JSON.
[[nodiscard]] std::string plan_text(const PlanConfig& config, const PlanResult& result);
[[nodiscard]] std::string plan_json(const PlanConfig& config, const PlanResult& result);

/// CSV grids and SVG figures into an existing folder.
[[nodiscard]] Expected<void> write_plan_tables(const std::filesystem::path& folder, const PlanConfig& config,
                                               const PlanResult& result);
[[nodiscard]] Expected<void> write_plan_figures(const std::filesystem::path& folder, const PlanConfig& config,
                                                const PlanResult& result);

struct PlanRun {
  std::filesystem::path folder;
  std::string summary_json, summary_text;
  bool met = false;
};
/// Runs a job and writes its folder (default: the job's name with .result). `monte_carlo` 0 or more overrides the job's
/// number of runs.
[[nodiscard]] Expected<PlanRun> run_plan(const std::filesystem::path& job, std::span<const std::string> overrides,
                                         const std::filesystem::path& output, int monte_carlo, int threads,
                                         Progress& progress);

extern const JobKind plan_job;

}  // namespace versine::app
