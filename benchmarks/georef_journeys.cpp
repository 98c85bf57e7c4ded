// SPDX-License-Identifier: Apache-2.0
#include "georef_journeys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <mutex>
#include <thread>

#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/io/network_labelled.hpp"
#include "versine/network/build.hpp"
#include "versine/sensors/imu_grade.hpp"
#include "versine/simulation/journey.hpp"
#include "versine/simulation/network_layout.hpp"
#include "versine/simulation/random.hpp"
#include "versine/simulation/world.hpp"

namespace versine::benchmarks {

using Eigen::Vector2d;

namespace {

constexpr double optimism = 1.5;  // told sigma times this is the true one

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Simulates and judges the journeys of one thread; each has a map of its own, since a projection is not shared.
class Driver {
 public:
  Driver(const Place& place, bool verbose) : place_(place), verbose_(verbose), map_(*network::build(place.source)) {
    if (place.centre) centre_ = map_.network.to_map(*place.centre);
    if (place.centre) return;
    Vector2d low(INFINITY, INFINITY), high = -low;
    for (const auto& t : map_.network.tracks) {
      for (const auto& p : t.line.points()) low = low.cwiseMin(p), high = high.cwiseMax(p);
    }
    centre_ = 0.5 * (low + high);
  }

  /// One journey, as each receiver records it.
  void run(std::uint64_t seed, std::span<const Receiver> receivers, std::vector<Score>& scores) {
    simulation::RandomStream random(seed, "journeys");
    std::shared_ptr<const simulation::World> driven;
    while (!driven) {
      auto made = simulation::prepare_journey(map_.network, scenario(random));
      if (made) driven = *made;
    }
    auto world = *driven;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
      const Receiver& receiver = receivers[i];
      world.equipment.gnss->sigma_horizontal = receiver.white;
      world.equipment.gnss->correlated_horizontal = receiver.coloured;
      world.equipment.gnss->correlation_time = receiver.correlation_time;
      solve(world, receiver, seed, scores[i]);
    }
  }

 private:
  void solve(const simulation::World& world, const Receiver& receiver, std::uint64_t seed, Score& score) const {
    const auto truth = simulation::observe(world, seed);
    simulation::RandomStream random(seed, "bridges");
    const auto recording = recording_of(truth, receiver, random);
    georef::Options options;
    options.gnss.correlation_time = receiver.told_time;
    const double begin = thread_seconds();
    const auto result = georef::georeference(map_, recording, options);
    score.seconds += thread_seconds() - begin;
    score.hours += world.duration / 3600.0;
    if (!result) {
      ++score.failed;
      std::fprintf(stderr, "%s %lu: %s\n", place_.name.c_str(), seed, result.error().message().c_str());
      return;
    }
    for (const auto& j : result->journeys) {
      judge(
          map_, j, truth, [this](const Vector2d& p) { return under_bridge(p); },
          [&](const auto& driven, const auto& found) {
            if (verbose_)
              std::fprintf(stderr, "%s seed %lu\n  driven %s\n  found  %s\n", place_.name.c_str(), seed,
                           fmt::format("{}", fmt::join(driven, " ")).c_str(),
                           fmt::format("{}", fmt::join(found, " ")).c_str());
          },
          score);
    }
  }

  [[nodiscard]] bool inside(const Vector2d& p) const { return !place_.centre || (p - centre_).norm() < place_.radius; }
  [[nodiscard]] bool under_bridge(const Vector2d& p) const {
    const double x = (p - centre_)[place_.across];
    return std::any_of(place_.bridges.begin(), place_.bridges.end(),
                       [&](double b) { return std::abs(x - b) < 25.0 && inside(p); });
  }

  std::optional<simulation::JourneyStop> random_stop(simulation::RandomStream& random) const {
    const auto& tracks = map_.network.tracks;
    const auto& t = tracks[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(tracks.size())))];
    if (t.line.length() < 110.0) return std::nullopt;
    const double d = random.uniform(50.0, t.line.length() - 50.0);
    if (!inside(t.line.position(d))) return std::nullopt;
    return simulation::JourneyStop{.track = t.id,
                                   .distance = d,
                                   .speed = random.uniform(6.0, 16.0),
                                   .acceleration = random.uniform(0.3, 0.6),
                                   .stand = random.uniform(15.0, 40.0)};
  }

  simulation::JourneyScenario scenario(simulation::RandomStream& random) const {
    simulation::JourneyScenario s;
    s.vehicle.bogie_distance = 9.0;
    s.vehicle.mounting = {0.05 * random.normal(), 0.05 * random.normal(), random.uniform(-3.1, 3.1)};
    simulation::ImuModel imu;
    imu.rate = 100.0;
    imu.errors = sensors::find_imu_grade("mems")->errors;
    imu.vibration_accelerometer = 0.003;
    s.equipment.imu = imu;
    simulation::GnssModel gnss;
    gnss.rate = 5.0;
    gnss.antenna = {0.0, 0.0, -2.0};
    gnss.sigma_velocity = 0.08;
    gnss.sigma_factor = optimism;
    s.equipment.gnss = gnss;
    for (int tries = 0; s.stops.size() < 3; ++tries) {
      if (tries % 200 == 199) s.stops.clear();  // a start from which no way leads on
      const auto stop = random_stop(random);
      if (!stop) continue;
      if (!s.stops.empty()) {
        const auto way = simulation::find_way(map_.network, s.stops.back(), *stop);
        if (!way || way->to - way->from < 200.0 || way->to - way->from > 4000.0) continue;
      }
      s.stops.push_back(*stop);
    }
    return s;
  }

  /// As the vehicle's recorder wrote it; under a bridge the receiver errs by metres and tells half of it.
  georef::Recording recording_of(const simulation::SimulatedRecording& r, const Receiver& receiver,
                                 simulation::RandomStream& random) const {
    georef::Recording out;
    out.name = "simulated";
    out.gnss = georef::to_fixes(r.gnss);
    Vector2d error = Vector2d::Zero();
    bool before = false;
    for (auto& f : out.gnss.samples) {
      const bool now = under_bridge(map_.network.to_map(f.position));
      if (now && !before) error = 4.0 * Vector2d(random.normal(), random.normal());
      before = now;
      if (!now) continue;
      f.position = map_.network.to_geodetic(map_.network.to_map(f.position) + error +
                                            Vector2d(random.normal(), random.normal()));
      f.sigma *= 2.0;
    }
    if (!receiver.imu) return out;
    const double rate = 1.0 / r.imu.interval.seconds();
    out.has_turn_rate = receiver.turn_rate;
    for (const auto& s : r.imu) {
      out.imu.samples.push_back(
          {s.time, rate * s.dvel, receiver.turn_rate ? Eigen::Vector3d(rate * s.dtheta) : Eigen::Vector3d::Zero()});
    }
    return out;
  }

  const Place& place_;
  bool verbose_;
  georef::Map map_;
  Vector2d centre_ = Vector2d::Zero();
};

}  // namespace

Place harbour() {
  simulation::NetworkLayout layout;
  layout.length = 6600.0;
  layout.crossovers = 9;
  layout.station_tracks = 5;
  return {"harbour", simulation::make_network(layout), {}, 0.0, 0, {-2200.0, -600.0, 1300.0}};
}

Expected<Place> utrecht(const std::string& data) {
  const auto source = io::read_labelled_network(data + "/dutch-network/subset_utrecht.geojson.zst");
  if (!source) return tl::unexpected(source.error());
  const geodesy::Geodetic station{52.0893 * units::deg, 5.1101 * units::deg, 0.0};
  return Place{"Utrecht", *source, station, 3000.0, 1, {-900.0, 150.0, 1100.0}};
}

std::vector<Score> drive(const Place& place, std::span<const Receiver> receivers, std::uint64_t count, int threads,
                         bool verbose) {
  std::vector<Score> sum(receivers.size());
  std::atomic<std::uint64_t> next{1};
  std::mutex mutex;
  std::vector<std::thread> pool;
  for (int t = 0; t < threads; ++t) {
    pool.emplace_back([&] {
      Driver driver(place, verbose);
      for (std::uint64_t seed = next++; seed <= count; seed = next++) {
        std::vector<Score> one(receivers.size());
        driver.run(seed, receivers, one);
        const std::scoped_lock lock(mutex);
        for (std::size_t i = 0; i < one.size(); ++i) add(sum[i], one[i]);
      }
    });
  }
  for (auto& t : pool) t.join();
  return sum;
}

}  // namespace versine::benchmarks
