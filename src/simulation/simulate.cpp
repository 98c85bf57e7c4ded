// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/simulate.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cmath>
#include <mutex>

#include "versine/geodesy/attitude.hpp"
#include "versine/simulation/imu.hpp"
#include "versine/simulation/random.hpp"
#include "versine/simulation/world.hpp"

namespace versine::simulation {

namespace {
RailTruth rail_truth(const TrackModel& track, const Rails& rails) {
  RailTruth truth;
  const auto count = static_cast<std::size_t>(std::floor(track.alignment.length() / track.grid)) + 1;
  // Deviations are drawn on the grid of the rails, which begins before the track.
  const double begin = rails.curve.begin();
  const auto before = static_cast<std::size_t>(std::llround(-begin / track.grid));
  const Deviations d = deviations(track, begin, track.grid,
                                  static_cast<std::size_t>(std::llround((rails.curve.end() - begin) / track.grid)) + 1);
  for (std::size_t i = 0; i < count; ++i) {
    const double s = static_cast<double>(i) * track.grid;
    const auto rail = rails.curve.value(s);
    const Eigen::Vector3d left = rail.head<3>(), right = rail.tail<3>();
    const design::DesignPoint p = track.alignment.at(s);
    truth.distance.push_back(s);
    truth.mileage.push_back(track.alignment.mileage(s));
    truth.left.push_back(rails.frame.to_geodetic(left));
    truth.right.push_back(rails.frame.to_geodetic(right));
    truth.gauge.push_back((right - left).norm());
    truth.cross_level.push_back((std::isnan(p.cant) ? 0.0 : p.cant) + d.cross_level[i + before]);
    truth.level.push_back(d.level[i + before]);
    truth.alignment.push_back(d.alignment[i + before]);
  }
  return truth;
}

std::vector<double> place_sleepers(const TrackModel& track) {
  if (!track.sleepers.empty()) return track.sleepers;
  std::vector<double> places;
  if (!(track.sleeper_spacing > 0.0)) return places;
  RandomStream random(track.seed, "track.sleepers");
  for (double s = 0.5 * track.sleeper_spacing; s < track.alignment.length(); s += track.sleeper_spacing) {
    places.push_back(s + track.sleeper_jitter * random.normal());
  }
  return places;
}

void observe_truth(const World& world, Truth& truth) {
  const auto count = static_cast<std::size_t>(world.duration * world.truth_rate);
  truth.trajectory.scale = world.time_scale;
  truth.trajectory.origin = "simulated truth";
  truth.trajectory.samples.reserve(count + 1);
  truth.progress.reserve(count + 1);
  for (std::size_t k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / world.truth_rate;
    const BodyState s = world.state(t);
    const MotionState m = world.motion(t);
    const geodesy::Geodetic g = world.frame.to_geodetic(s.position);
    const Eigen::Matrix3d C_nl = world.frame.rotation_from(g).transpose();
    truth.trajectory.samples.push_back({.time = world.time(t),
                                        .position = g,
                                        .v_eb_n = C_nl * s.velocity,
                                        .q_nb = Eigen::Quaterniond(Eigen::Matrix3d(C_nl * s.C_lb))});
    LinePlace place = world.piece_at(t).place(m.distance);
    truth.progress.push_back(
        {world.time(t), m.distance, place.mileage, m.speed, std::move(place.track), place.track_distance});
  }
  for (const Stop& stop : world.stops) {
    truth.standstills.push_back({world.time(stop.from), world.time(stop.to), stop.distance});
  }
  truth.rails = world.rails;
  truth.sleepers = world.sleepers;
}
}  // namespace

Expected<std::shared_ptr<const World>> prepare(const Scenario& scenario) {
  if (auto good = check(scenario); !good) return tl::unexpected(std::move(good.error()));
  auto rails = build_rails(scenario.track);
  if (!rails) return tl::unexpected(std::move(rails.error()));
  auto motion = SpeedProfile::create(scenario.motion, rails->begin, rails->end, scenario.track.seed);
  if (!motion) return tl::unexpected(std::move(motion.error()));

  auto world = std::make_shared<World>();
  world->equipment = scenario.equipment;
  world->vehicle = scenario.vehicle.has_value();
  world->trolley = scenario.trolley;
  if (scenario.vehicle) world->trolley.mounting = scenario.vehicle->mounting;
  world->start = scenario.start;
  world->time_scale = scenario.time_scale;
  world->duration = motion->duration();
  world->truth_rate = scenario.truth_rate;
  world->frame = rails->frame;
  world->stops = motion->stops();
  world->sleepers = place_sleepers(scenario.track);
  world->rails = rail_truth(scenario.track, *rails);
  world->curve = rails->curve;
  Body body(*rails, scenario.trolley, scenario.vehicle, scenario.motion.facing_back ? -1.0 : 1.0, motion->reach());
  world->pieces.push_back({0.0, motion->duration(), std::move(*motion), std::move(body),
                           [chainage = scenario.track.alignment.chainage](double s) {
                             return LinePlace{chainage.mileage(s), {}, 0.0};
                           }});
  complete(*world);
  return world;
}

void complete(World& world) {
  if (!world.equipment.imu) return;
  const auto state = [&](double t) { return world.state(t); };
  world.ideal_imu = ideal_imu(state, world.w_ie_l(), world.duration, world.equipment.imu->rate, world.start);
  world.ideal_imu.scale = world.time_scale;
}

SimulatedRecording observe(const World& world, std::uint64_t seed) {
  SimulatedRecording r;
  r.scale = world.time_scale;
  r.origin = world.frame.origin();
  observe_truth(world, r.truth);
  const Equipment& on = world.equipment;
  if (on.imu) {
    r.imu = with_errors(
        world.ideal_imu, *on.imu, on.temperature, [&](double t) { return world.motion(t).speed; }, world.start, seed,
        r.truth);
  }
  for (std::size_t i = 0; i < on.odometers.size(); ++i) {
    r.odometers.push_back(observe_odometer(world, on.odometers[i], i, seed, r.truth));
  }
  if (on.gauge) r.gauge = observe_gauge(world, *on.gauge, seed, r.truth);
  if (on.sleeper) r.sleeper = observe_sleepers(world, *on.sleeper, seed);
  if (on.gnss) r.gnss = observe_gnss(world, *on.gnss, seed, r.truth);
  if (on.total_station) observe_total_station(world, *on.total_station, seed, r);
  if (on.axle_box) r.axle_box = observe_axle_box(world, *on.axle_box, seed);
  for (const Fault& fault : on.faults) apply_fault(fault, world.start, r);
  return r;
}

Expected<SimulatedRecording> simulate(const Scenario& scenario, std::uint64_t seed) {
  auto world = prepare(scenario);
  if (!world) return tl::unexpected(std::move(world.error()));
  return observe(**world, seed);
}

void simulate_runs(const World& world, std::uint64_t seed, std::uint64_t runs, int threads,
                   const std::function<void(std::uint64_t, SimulatedRecording&&)>& use, Progress& progress) {
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  std::mutex one_at_a_time;
  std::uint64_t done = 0;
  arena.execute([&] {
    tbb::parallel_for(std::uint64_t{0}, runs, [&](std::uint64_t run) {
      if (progress.cancelled()) return;
      SimulatedRecording recording = observe(world, run_seed(seed, run));
      const std::scoped_lock lock(one_at_a_time);
      use(run, std::move(recording));
      progress.report("runs", static_cast<double>(++done) / static_cast<double>(runs));
    });
  });
}

}  // namespace versine::simulation
