// SPDX-License-Identifier: Apache-2.0
// Simulated journeys of an in-service vehicle through georeferencing against the truth: one row of a Markdown table a
// set of journeys, and a diagram of how often paths of a given probability are right.
// versine_georef_accuracy [--journeys 500] [--threads 2] [--data FOLDER] [--svg FILE] [--only NAME] [--verbose]
#include <time.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <mutex>
#include <span>
#include <thread>

#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/georef/georeference.hpp"
#include "versine/io/network_labelled.hpp"
#include "versine/network/build.hpp"
#include "versine/report/figure.hpp"
#include "versine/sensors/imu_grade.hpp"
#include "versine/simulation/journey.hpp"
#include "versine/simulation/network_layout.hpp"
#include "versine/simulation/random.hpp"
#include "versine/simulation/simulate.hpp"
#include "versine/simulation/world.hpp"

using namespace versine;
using Eigen::Vector2d;

namespace {

/// A set of journeys: where, and how good GNSS is.
struct Place {
  std::string name;
  network::NetworkSource source;
  std::optional<geodesy::Geodetic> centre;  ///< stops lie within `radius` of it; none: anywhere
  double radius = 0.0;                      ///< m
  int across = 0;                           ///< bridges cross the tracks: 0: they go north, 1: east
  std::vector<double> bridges;              ///< their axes, m east (north) of the middle of the stops' area; 50 m wide
};
struct Receiver {
  std::string name;
  double white, coloured, correlation_time;  ///< m, m, s: true errors of each axis
  double told_time;                          ///< s, in the job
  bool imu, turn_rate;
};

constexpr double optimism = 1.5;  // told sigma times this is the true one

/// Right or wrong, by the probability that was told.
struct Decision {
  double probability;
  bool right;
};
struct Score {
  std::size_t journeys = 0, right = 0, failed = 0, hypotheses = 0, n_good = 0, n_bad = 0, inside = 0;
  double square_good = 0, square_bad = 0, seconds = 0, hours = 0, normalised = 0;
  std::vector<Decision> paths, switches;
};

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
    for (const auto& j : result->journeys) judge(j, truth, seed, score);
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

  void judge(const georef::JourneyResult& j, const simulation::SimulatedRecording& r, std::uint64_t seed,
             Score& score) const {
    std::vector<const simulation::ProgressPoint*> points;
    std::vector<std::string> driven;
    for (const auto& p : r.truth.progress) {
      if (p.time < j.start || j.end() < p.time) continue;
      points.push_back(&p);
      if (driven.empty() || driven.back() != p.track) driven.push_back(p.track);
    }
    if (points.empty()) return;
    ++score.journeys;
    score.hypotheses += j.paths.size();
    for (std::size_t i = 0; i < j.paths.size(); ++i) {
      const bool right = names(j.paths[i]) == driven;
      score.paths.push_back({j.paths[i].probability, right});
      if (i == 0 && right) ++score.right;
      if (i == 0 && !right && verbose_) {
        std::printf("%s seed %lu: probability %.4f of %zu\n  driven", place_.name.c_str(), seed, j.paths[i].probability,
                    j.paths.size());
        for (const auto& id : driven) std::printf(" %s", id.c_str());
        std::printf("\n  found ");
        for (const auto& id : names(j.paths[i])) std::printf(" %s", id.c_str());
        std::printf("\n");
      }
    }
    for (const auto& s : j.switches) {
      const auto& from = map_.network.tracks[s.from.track].id;
      const auto at = std::find(driven.begin(), driven.end(), from);
      if (at == driven.end() || at + 1 == driven.end()) continue;
      score.switches.push_back({s.probability, *(at + 1) == map_.network.tracks[s.to.track].id});
    }
    if (names(j.paths.front()) == driven) measure(j, points, r, score);
  }

  [[nodiscard]] std::vector<std::string> names(const georef::PathSolution& p) const {
    std::vector<std::string> out;
    const auto& starts = p.coordinates.starts();
    for (std::size_t i = 0; i < p.coordinates.path().size(); ++i) {
      if (starts[i + 1] <= p.motion.distance.front() || starts[i] >= p.motion.distance.back()) continue;
      out.push_back(map_.network.tracks[p.coordinates.path()[i].track].id);
    }
    return out;
  }

  void measure(const georef::JourneyResult& j, const std::vector<const simulation::ProgressPoint*>& points,
               const simulation::SimulatedRecording& r, Score& score) const {
    const auto& p = j.paths.front();
    const auto& path = p.coordinates.path();
    std::size_t i = 0;
    std::vector<Time> bridge;
    for (const auto& f : r.gnss) {
      if (under_bridge(map_.network.to_map(f.position))) bridge.push_back(f.time);
    }
    for (const auto* t : points) {
      while (i < path.size() && map_.network.tracks[path[i].track].id != t->track) ++i;
      if (i == path.size()) return;
      const double length = map_.network.tracks[path[i].track].line.length();
      const double truth =
          p.coordinates.starts()[i] + (path[i].reversed ? length - t->track_distance : t->track_distance);
      const auto k =
          std::min(j.steps - 1, static_cast<std::size_t>(std::lround((t->time - j.start).seconds() / j.grid)));
      const double error = p.motion.distance[k] - truth, sigma = p.motion.sigma_distance[k];

      const bool good =
          std::none_of(bridge.begin(), bridge.end(), [&](Time b) { return std::abs((t->time - b).seconds()) < 10.0; });
      (good ? score.square_good : score.square_bad) += error * error;
      ++(good ? score.n_good : score.n_bad);
      score.inside += std::abs(error) < 1.96 * sigma;
      score.normalised += error * error / (sigma * sigma);
    }
  }

  const Place& place_;
  bool verbose_;
  georef::Map map_;
  Vector2d centre_ = Vector2d::Zero();
};

void add(Score& to, const Score& s) {
  to.journeys += s.journeys, to.right += s.right, to.failed += s.failed, to.hypotheses += s.hypotheses;
  to.n_good += s.n_good, to.n_bad += s.n_bad, to.inside += s.inside, to.seconds += s.seconds, to.hours += s.hours;
  to.square_good += s.square_good, to.square_bad += s.square_bad, to.normalised += s.normalised;
  to.paths.insert(to.paths.end(), s.paths.begin(), s.paths.end());
  to.switches.insert(to.switches.end(), s.switches.begin(), s.switches.end());
}

std::vector<Score> drive(const Place& place, std::span<const Receiver> receivers, std::uint64_t journeys, int threads,
                         bool verbose) {
  std::vector<Score> sum(receivers.size());
  std::atomic<std::uint64_t> next{1};
  std::mutex mutex;
  std::vector<std::thread> pool;
  for (int t = 0; t < threads; ++t) {
    pool.emplace_back([&] {
      Driver driver(place, verbose);
      for (std::uint64_t seed = next++; seed <= journeys; seed = next++) {
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

/// How often decisions told with a probability were right, in bins; and the Brier score.
report::Curve reliability(std::string name, std::vector<Decision> decisions, std::string& text) {
  report::Curve curve{.name = std::move(name), .x = {}, .y = {}, .style = report::CurveStyle::points};
  double brier = 0.0;
  for (const auto& d : decisions) brier += std::pow(d.probability - (d.right ? 1.0 : 0.0), 2);
  constexpr int bins = 10;
  for (int b = 0; b < bins; ++b) {
    double p = 0, right = 0, n = 0;
    for (const auto& d : decisions) {
      if (std::min(bins - 1, static_cast<int>(d.probability * bins)) != b) continue;
      p += d.probability, right += d.right, n += 1;
    }
    char cell[80];
    std::snprintf(cell, sizeof cell, n > 0 ? " %.3f -> %.3f (%.0f);" : " -;", p / n, right / n, n);
    text += cell;
    if (n < 10) continue;
    curve.x.push_back(p / n), curve.y.push_back(right / n);
  }
  char end[60];
  std::snprintf(end, sizeof end, " Brier %.4f",
                brier / static_cast<double>(std::max<std::size_t>(1, decisions.size())));
  text += end;
  return curve;
}

network::NetworkSource harbour() {
  simulation::NetworkLayout layout;
  layout.length = 6600.0;
  layout.crossovers = 9;
  layout.station_tracks = 5;
  return simulation::make_network(layout);
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t journeys = 500;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::string data = VERSINE_SOURCE "/../shared/data", svg, only;
  bool verbose = false;
  for (int i = 1; i < argc; ++i) {
    const auto is = [&](const char* name) { return std::strcmp(argv[i], name) == 0 && i + 1 < argc; };
    if (is("--journeys"))
      journeys = std::strtoull(argv[++i], nullptr, 10);
    else if (is("--threads"))
      threads = std::atoi(argv[++i]);
    else if (is("--data"))
      data = argv[++i];
    else if (is("--svg"))
      svg = argv[++i];
    else if (is("--only"))
      only = argv[++i];
    else
      verbose = true;
  }
  std::vector<Place> places{{"harbour", harbour(), {}, 0.0, 0, {-2200.0, -600.0, 1300.0}}};
  const auto utrecht = io::read_labelled_network(data + "/dutch-network/subset_utrecht.geojson.zst");
  if (utrecht) {
    places.push_back({"Utrecht",
                      *utrecht,
                      geodesy::Geodetic{52.0893 * units::deg, 5.1101 * units::deg, 0.0},
                      3000.0,
                      1,
                      {-900.0, 150.0, 1100.0}});
  } else {
    std::printf("%s\n", utrecht.error().message().c_str());
  }
  const Receiver receivers[] = {{"1 m, 15 s", 0.45, 0.9, 15.0, 15.0, true, true},
                                {"1 m, 15 s, GNSS only", 0.45, 0.9, 15.0, 15.0, false, false},
                                {"1 m, 60 s, told", 0.45, 0.9, 60.0, 60.0, true, true},
                                {"1 m, 60 s, told 15 s", 0.45, 0.9, 60.0, 15.0, true, true},
                                {"3 m, 15 s", 1.35, 2.7, 15.0, 15.0, true, true},
                                {"3 m, 15 s, GNSS only", 1.35, 2.7, 15.0, 15.0, false, false}};
  report::Figure figure{.title = "Are paths as probable as they say?",
                        .x = {"probability told", 0.0, 1.0, false},
                        .y = {"share that was right", 0.0, 1.0, false},
                        .curves = {{"ideal", {0.0, 1.0}, {0.0, 1.0}, report::CurveStyle::dashed, 7}},
                        .field = {}};
  std::printf(
      "| network | GNSS error | journeys | right path | along, RMS | near bridges | coverage of 95 %% | NEES | paths | "
      "CPU a journey |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  std::string reliabilities;
  for (const auto& place : places) {
    if (place.name.find(only) == std::string::npos) continue;
    const auto scores = drive(place, receivers, journeys, threads, verbose);
    for (std::size_t i = 0; i < scores.size(); ++i) {
      const Receiver& receiver = receivers[i];
      const Score& s = scores[i];
      const std::string name = place.name + ", " + receiver.name;
      const auto n = static_cast<double>(s.n_good + s.n_bad), count = static_cast<double>(s.journeys);
      std::printf("| %s | %s | %zu | %.2f %% | %.3f m | %.3f m | %.1f %% | %.2f | %.1f | %.1f ms |\n",
                  place.name.c_str(), receiver.name.c_str(), s.journeys, 100.0 * static_cast<double>(s.right) / count,
                  std::sqrt(s.square_good / static_cast<double>(s.n_good)),
                  std::sqrt(s.square_bad / static_cast<double>(s.n_bad)), 100.0 * static_cast<double>(s.inside) / n,
                  s.normalised / n, static_cast<double>(s.hypotheses) / count, 1000.0 * s.seconds / count);
      std::fflush(stdout);
      std::string text;
      auto curve = reliability(name, s.paths, text);
      if (!receiver.imu || receiver.white > 1.0) figure.curves.push_back(std::move(curve));
      reliabilities += "paths, " + name + ":" + text + "\n";
      text.clear();
      static_cast<void>(reliability("", s.switches, text));
      reliabilities += "switches, " + name + ":" + text + "\n";
    }
  }
  std::printf("\n%s", reliabilities.c_str());
  if (!svg.empty()) std::ofstream(svg) << report::to_svg(figure);
}
