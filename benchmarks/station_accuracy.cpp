// SPDX-License-Identifier: Apache-2.0
// Surveys from raw total-station readings: the tables of docs/total-station.md.
// versine_station_accuracy SCENARIO.toml [STATIONING_SEEDS] [SURVEY_SEEDS] [key=value ...]   (keys of the survey job;
// "sim:key=value" of the scenario)
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>

#include "versine/app/compare.hpp"
#include "versine/app/felt_up.hpp"
#include "versine/app/simulate.hpp"
#include "versine/app/survey_config.hpp"
#include "versine/fusion/aided_ins.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/simulation/simulate.hpp"
#include "versine/simulation/world.hpp"

using namespace versine;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// An error ends the program with its message (main).
struct Failure {
  std::string message;
};

struct Program {
  app::SimulateConfig config;
  std::shared_ptr<const simulation::World> world;
  std::vector<std::string> overrides;
  std::string path;
};

/// The job as `versine simulate` writes it.
app::SurveyConfig job_of(const Program& p, const app::SimulateConfig& config, const simulation::SimulatedRecording& r) {
  app::SurveyConfig job;
  const auto done = app::parse_config(
      app::survey_job_for(config, r, false), std::filesystem::absolute(p.path),
      [&](app::ConfigVisitor& v) { describe(v, job); }, p.overrides);
  if (!done) throw Failure{done.error().message()};
  job.estimator.imu_errors = *job.imu_errors.errors();
  return job;
}

app::StationingOutcome stations_of(const simulation::SimulatedRecording& r, const app::StationingProcessing& job) {
  SilentProgress progress;
  return app::compute_landmarks(r.stationings, *stationing::ControlNetwork::create(r.control_points),
                                geodesy::LocalFrame(r.origin), job, progress);
}

/// Stands of the scenario without its IMU's recording: what its accelerometers would feel.
void feel_up(simulation::SimulatedRecording& r, const simulation::World& world, const sensors::TriadErrors& a,
             std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&](double sigma) -> Eigen::Vector3d {
    return sigma * Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  const Eigen::Vector3d bias = draw(a.bias / units::standard_gravity);
  for (auto& s : r.stationings) {
    const double t = 0.5 * ((*s.from - world.start).seconds() + (*s.to - world.start).seconds());
    const double sigma = app::felt_up_sigma(a, (*s.to - *s.from).seconds());
    const Eigen::Vector3d up = world.C_lv(t).transpose() * -Eigen::Vector3d::UnitZ();
    s.felt_up = stationing::FeltUp{(up + bias + draw(sigma)).normalized(), sigma};
  }
}

/// What all stations of all seeds add up to.
struct Tally {
  Vector6 squares = Vector6::Zero(), variances = Vector6::Zero();
  double nees_attitude = 0.0, nees = 0.0;
  std::size_t stations = 0, inside[6] = {}, failed = 0, blunders = 0, found = 0, good = 0, lost = 0, moved = 0,
              moved_found = 0, moved_wrong = 0;

  void add(const stationing::StationResult& s, const simulation::World& world,
           const simulation::TotalStationModel& model) {
    const double t = 0.5 * ((*s.from - world.start).seconds() + (*s.to - world.start).seconds());
    const Eigen::Matrix3d C_ms = world.C_lv(t) * geodesy::to_matrix(model.mounting);
    // Along the track, across and up, so that a curve does not mix them.
    const Eigen::Matrix3d C_vm = world.C_lv(t).transpose();
    Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = C_vm;
    Vector6 e;
    e << world.point(t, model.place) - s.position,
        geodesy::to_rotation_vector(Eigen::Quaterniond(C_ms) * s.q_ms.conjugate());
    e = turn * e;
    const Eigen::Matrix<double, 6, 6> p = turn * s.covariance.topLeftCorner<6, 6>() * turn.transpose();
    squares += e.cwiseAbs2();
    variances += p.diagonal();
    nees += e.dot(p.llt().solve(e));
    nees_attitude += e.tail<3>().dot(p.bottomRightCorner<3, 3>().llt().solve(e.tail<3>()));
    for (int k = 0; k < 6; ++k) inside[k] += std::abs(e[k]) < 1.96 * std::sqrt(p(k, k));
    ++stations;
  }

  void count_faults(const app::StationingOutcome& o, const simulation::Truth& truth) {
    std::map<std::pair<std::string, std::string>, bool> wrong;
    for (const auto& w : truth.wrong_sightings) wrong[{w.station, w.point}] = false;
    for (const auto& s : o.run.stations) {
      for (const auto& x : s.excluded) {
        const auto it = wrong.find({s.name, x.point});
        const bool has_moved = std::count(truth.moved_points.begin(), truth.moved_points.end(), x.point) > 0;
        if (it != wrong.end()) it->second = true;
        lost += it == wrong.end() && !has_moved;
      }
      good += s.targets.size();
    }
    for (const auto& [key, seen] : wrong) blunders += 1, found += seen;
    moved += truth.moved_points.size();
    for (const auto& m : o.run.moved) {
      const bool right = std::count(truth.moved_points.begin(), truth.moved_points.end(), m.name) > 0;
      (right ? moved_found : moved_wrong) += 1;
    }
    failed += o.run.failed.size();
  }

  [[nodiscard]] double rms(int k) const { return std::sqrt(squares[k] / double(stations)); }
  [[nodiscard]] double sigma(int k) const { return std::sqrt(variances[k] / double(stations)); }
  [[nodiscard]] double share(int from) const {
    return 100.0 * double(inside[from] + inside[from + 1] + inside[from + 2]) / (3.0 * double(stations));
  }
};

void print_row(const char* name, const Tally& t) {
  std::printf(
      "| %s | %zu | %.2f, %.2f, %.2f | %.2f, %.2f, %.2f | %.1f %% | %.2f | %zu of %zu | %zu of %zu | %zu of %zu, %zu "
      "|\n",
      name, t.stations, t.rms(0) * 1e3, t.rms(1) * 1e3, t.rms(2) * 1e3, t.sigma(0) * 1e3, t.sigma(1) * 1e3,
      t.sigma(2) * 1e3, t.share(0), t.nees / double(t.stations) / 6.0, t.found, t.blunders, t.lost, t.good + t.lost,
      t.moved_found, t.moved, t.moved_wrong);
}

void print_attitude(const char* name, const Tally& t) {
  constexpr double s = 1.0 / units::arcsec;
  std::printf("| %s | %.1f, %.1f, %.1f | %.1f, %.1f, %.1f | %.1f %% | %.2f |\n", name, t.rms(3) * s, t.rms(4) * s,
              t.rms(5) * s, t.sigma(3) * s, t.sigma(4) * s, t.sigma(5) * s, t.share(3),
              t.nees_attitude / double(t.stations) / 3.0);
}

/// Only the total station is simulated: a survey's stations in a millisecond.
Tally stationing_table(const Program& p, int targets, double blunder, int seeds) {
  app::SimulateConfig config = p.config;
  config.total_station.targets = targets;
  config.total_station.sighting_blunder_size = blunder;
  if (blunder == 0.0) config.total_station.sighting_blunder = 0.0, config.total_station.moved_points = 0;
  Tally tally;
  for (int seed = 0; seed < seeds; ++seed) {
    simulation::SimulatedRecording r;
    r.origin = p.world->frame.origin();
    simulation::observe_total_station(*p.world, config.total_station, static_cast<std::uint64_t>(5000 + seed), r);
    const app::SurveyConfig job = job_of(p, config, r);
    feel_up(r, *p.world, job.estimator.imu_errors.accelerometer, static_cast<std::uint64_t>(7000 + seed));
    const auto o = stations_of(r, job.total_station);
    for (const auto& s : o.run.stations) tally.add(s, *p.world, config.total_station);
    tally.count_faults(o, r.truth);
  }
  return tally;
}

/// Squared RMS and coverage of trajectories, seed by seed.
struct Runs {
  double squares[6] = {}, inside[6] = {}, count = 0.0;
  void add(const app::TrajectoryComparison& c) {
    const app::DifferenceStatistics* d[] = {&c.along, &c.across, &c.up, &c.roll, &c.pitch, &c.heading};
    for (int k = 0; k < 6; ++k) squares[k] += d[k]->rms * d[k]->rms, inside[k] += d[k]->coverage;
    count += 1.0;
  }
  void print(const char* name) const {
    std::printf("| %s |", name);
    for (int k = 0; k < 6; ++k) {
      std::printf(" %.2f (%.1f %%) |", std::sqrt(squares[k] / count) * (k < 3 ? 1e3 : 1.0 / units::arcsec),
                  100.0 * inside[k] / count);
    }
    std::printf("\n");
  }
};

void survey_table(const Program& p, int seeds) {
  Runs positions, readings, without_attitude;
  SilentProgress progress;
  SilentLog log;
  for (int seed = 0; seed < seeds; ++seed) {
    auto r = simulation::observe(*p.world, static_cast<std::uint64_t>(9000 + seed));
    const app::SurveyConfig job = job_of(p, p.config, r);
    app::feel_up(r.stationings, r.imu, job.estimator.imu_errors.accelerometer);
    auto from_readings = stations_of(r, job.total_station).landmarks;
    auto bare = from_readings;
    for (auto& l : bare) l.q_ns.reset();
    for (const auto& [landmarks, runs] :
         {std::pair{&r.landmarks, &positions}, {&from_readings, &readings}, {&bare, &without_attitude}}) {
      fusion::AidedInsInput in{.imu = r.imu, .odometer = r.odometers.front()};
      in.landmarks.samples = *landmarks;
      const auto solved = fusion::run_aided_ins(in, job.estimator, progress, log);
      if (!solved) throw Failure{solved.error().message()};
      runs->add(*app::compare_trajectories(solved->solution.smoothed, r.truth.trajectory));
    }
    std::fprintf(stderr, "survey %d of %d\r", seed + 1, seeds);
  }
  std::printf(
      "\n| input | along, mm | across, mm | up, mm | roll, \" | pitch, \" | heading, \" "
      "|\n|---|---|---|---|---|---|---|\n");
  positions.print("positions of 0.6 mm");
  without_attitude.print("raw readings, position");
  readings.print("raw readings, position and attitude");
}

void stationing_tables(const Program& p, int seeds) {
  std::printf("%s, %d surveys\n\n", p.config.title.c_str(), seeds);
  std::vector<std::pair<std::string, Tally>> rows;
  for (int targets = 5; targets <= 8; ++targets) {
    rows.emplace_back(std::to_string(targets) + ", none", stationing_table(p, targets, 0.0, seeds));
    for (const double mm : {5.0, 8.0, 15.0}) {
      char name[64];
      std::snprintf(name, sizeof name, "%d, %.0f mm", targets, mm);
      rows.emplace_back(name, stationing_table(p, targets, mm * 1e-3, seeds));
    }
  }
  std::printf(
      "| back-sights, blunders | stations | RMS along, across, up, mm | own sigma, mm | position in 1.96 sigma | "
      "NEES/6 | "
      "blunders found | good targets left out | moved points found, wrongly named |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, t] : rows) print_row(name.c_str(), t);
  std::printf(
      "\n| back-sights, blunders | RMS roll, pitch, yaw, \" | own sigma, \" | in 1.96 sigma | NEES/3 |\n"
      "|---|---|---|---|---|\n");
  for (const auto& [name, t] : rows) print_attitude(name.c_str(), t);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::printf("versine_station_accuracy SCENARIO.toml [SEEDS] [SURVEYS] [key=value ...]\n"), 2;
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 60, surveys = argc > 3 ? std::atoi(argv[3]) : 6;
  Program p{.path = argv[1]};
  std::vector<std::string> simulated;
  for (int i = 4; i < argc; ++i) {
    const std::string text = argv[i];
    text.starts_with("sim:") ? simulated.push_back(text.substr(4)) : p.overrides.push_back(text);
  }
  auto config = app::read_simulate_config(p.path, simulated);
  if (!config) return std::fprintf(stderr, "%s\n", config.error().message().c_str()), 2;
  p.config = std::move(*config);
  const auto world = simulation::prepare(p.config.scenario);
  if (!world) return std::fprintf(stderr, "%s\n", world.error().message().c_str()), 2;
  p.world = *world;
  try {
    if (seeds > 0) stationing_tables(p, seeds);
    if (surveys > 0) survey_table(p, surveys);
  } catch (const Failure& f) {
    std::fprintf(stderr, "%s\n", f.message.c_str());
    return 1;
  }
  return 0;
}
