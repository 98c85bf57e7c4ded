// SPDX-License-Identifier: Apache-2.0
// Blunders and moved points as all stations of a survey see them together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stationing/generator.hpp"

namespace versine::stationing {
namespace {

using namespace test;

enum class Fault { direction, zenith, distance };

/// Adds a blunder of `size` m to all readings of one target.
void spoil(Stationing& s, const std::string& point, Fault fault, double size) {
  for (Sighting& r : s.sightings) {
    if (r.point != point) continue;
    const double angle = size / r.distance;
    if (fault == Fault::direction) r.direction += angle / std::abs(std::sin(r.zenith));
    if (fault == Fault::zenith) r.zenith += r.face == Face::one ? angle : -angle;
    if (fault == Fault::distance) r.distance += size;
  }
}

struct SnoopedSurvey {
  std::mt19937 rng;
  std::vector<ControlPoint> nominal, real;
  std::vector<Truth> truth;
  std::vector<Stationing> stations;
  std::map<std::string, std::string> wrong;  ///< station to the point of its wrong sighting

  SnoopedSurvey(unsigned seed, std::size_t targets) : rng(seed) {
    nominal = pairs_along(660.0, rng);
    real = real_places(nominal, rng);
    for (double s = 50.0; s < 620.0; s += 60.0) {
      truth.push_back(trolley(s, rng));
      stations.push_back(readings(truth.back(), real, targets, 1, rng));
      stations.back().name = "S" + std::to_string(stations.size());
    }
  }
  /// One target of a station in three is read wrong.
  void add_blunders(double size) {
    for (Stationing& s : stations) {
      if (rng() % 3 != 0) continue;
      const std::string point = s.sightings[rng() % s.sightings.size()].point;
      spoil(s, point, static_cast<Fault>(rng() % 3), rng() % 2 == 0 ? size : -size);
      wrong[s.name] = point;
    }
  }
  /// Accelerometers that lie somehow against the instrument, with a bias, and `sigma` from station to station.
  void feel_up(double sigma) {
    const Eigen::Quaterniond q_bs = geodesy::to_quaternion(geodesy::Euler{0.02, -0.03, 1.2});
    std::normal_distribution<double> noise(0.0, sigma);
    for (std::size_t i = 0; i < stations.size(); ++i) {
      const Eigen::Vector3d up_s = truth[i].q_ms.conjugate() * up_at(truth[i].position);
      const Eigen::Vector3d error(2e-4 + noise(rng), -1e-4 + noise(rng), 0.0);
      stations[i].felt_up = FeltUp{(q_bs * up_s + error).normalized(), sigma};
    }
  }
  [[nodiscard]] StationingRun run() const {
    SilentProgress progress;
    return compute_stations(stations, *ControlNetwork::create(nominal), {}, {}, progress);
  }
};

bool excludes(const StationResult& s, const std::string& point) {
  return std::any_of(s.excluded.begin(), s.excluded.end(), [&](const Exclusion& e) { return e.point == point; });
}

/// Of five back-sights some check each other so little that no neighbour helps: then the result says of the wrong one
/// that a blunder of its size would not be seen.
bool told_as_unseen(const StationResult& s, const std::string& point, double size) {
  return std::any_of(s.targets.begin(), s.targets.end(),
                     [&](const TargetResult& t) { return t.point == point && t.detectable.maxCoeff() > size; });
}

/// What the station misses by itself, its neighbours tell.
TEST(JointSnooping, EveryBlunderOverFiveMillimetresIsFound) {
  for (const std::size_t targets : {5u, 6u, 8u}) {
    std::size_t blunders = 0, found = 0, good = 0, lost = 0, alone = 0, unseen = 0, moved = 0, stations = 0;
    Eigen::Array3d squares = Eigen::Array3d::Zero();
    for (unsigned seed = 0; seed < 40; ++seed) {
      SnoopedSurvey survey(3000 + seed, targets);
      survey.add_blunders(5.5e-3);
      const StationingRun run = survey.run();
      ASSERT_EQ(run.stations.size(), survey.stations.size());
      for (std::size_t i = 0; i < run.stations.size(); ++i) {
        const StationResult& s = run.stations[i];
        const auto it = survey.wrong.find(s.name);
        if (it != survey.wrong.end()) {
          ++blunders;
          found += excludes(s, it->second);
          unseen += !excludes(s, it->second) && told_as_unseen(s, it->second, 5e-3);
          const auto reduced = reduce(survey.stations[i], {});
          alone += excludes(*free_station(*reduced, *ControlNetwork::create(survey.nominal), {}, {}), it->second);
        }
        for (const auto& e : s.excluded) lost += it == survey.wrong.end() || e.point != it->second;
        good += s.targets.size();
        squares += (s.position - survey.truth[i].position).array().square();
        ++stations;
      }
      moved += run.moved.size();
    }
    const Eigen::Array3d rms = 1e3 * (squares / double(stations)).sqrt();
    std::printf("%zu targets: %zu of %zu found (alone %zu), %zu of %zu good lost, RMS %.2f %.2f %.2f mm\n", targets,
                found, blunders, alone, lost, good, rms[0], rms[1], rms[2]);
    EXPECT_EQ(found + unseen, blunders);
    if (targets == 5) continue;
    EXPECT_EQ(unseen, 0u);
    EXPECT_LE(moved, 1u);  // of 40 surveys of 24 points, each tested at 0.01 %
    EXPECT_LT(double(lost) / double(good), 0.005);
    EXPECT_LT(rms.maxCoeff(), 0.5);
  }
}

/// Of five back-sights two zenith angles on opposite corners explain each other by a tilt, which accelerometers know.
TEST(JointSnooping, AccelerometersTellWhichOfTwoZenithAnglesIsWrong) {
  for (const double size : {5.5e-3, 15e-3}) {
    std::size_t blunders = 0, found = 0, lost = 0, inside = 0, stations = 0;
    Eigen::Array3d squares = Eigen::Array3d::Zero();
    for (unsigned seed = 0; seed < 40; ++seed) {
      SnoopedSurvey survey(3000 + seed, 5);
      survey.add_blunders(size);
      survey.feel_up(10.0 * units::arcsec);
      const StationingRun run = survey.run();
      ASSERT_EQ(run.stations.size(), survey.stations.size());
      for (std::size_t i = 0; i < run.stations.size(); ++i) {
        const StationResult& s = run.stations[i];
        const auto it = survey.wrong.find(s.name);
        blunders += it != survey.wrong.end();
        if (it != survey.wrong.end()) found += excludes(s, it->second);
        for (const auto& e : s.excluded) lost += it == survey.wrong.end() || e.point != it->second;
        const Eigen::Array3d error = s.position - survey.truth[i].position;
        squares += error.square();
        for (int k = 0; k < 3; ++k) inside += std::abs(error[k]) < 1.96 * std::sqrt(s.covariance(k, k));
        stations += 1;
      }
    }
    const Eigen::Array3d rms = 1e3 * (squares / double(stations)).sqrt();
    std::printf("%.1f mm: %zu of %zu found, %zu good lost, RMS %.2f %.2f %.2f mm, inside %.3f\n", size * 1e3, found,
                blunders, lost, rms[0], rms[1], rms[2], double(inside) / double(3 * stations));
    EXPECT_EQ(found, blunders);
    EXPECT_LT(rms.maxCoeff(), 0.5);
    EXPECT_NEAR(double(inside) / double(3 * stations), 0.95, 0.02);
  }
}

/// The instrument was turned on the trolley between its stations: what was felt then tells nothing, and changes
/// nothing.
TEST(JointSnooping, AccelerometersThatContradictMostStationsAreNotUsed) {
  for (unsigned seed = 3000; seed < 3020; ++seed) {
    SnoopedSurvey survey(seed, 5);
    survey.add_blunders(15e-3);
    const StationingRun alone = survey.run();
    survey.feel_up(10.0 * units::arcsec);
    for (std::size_t i = 0; i < survey.stations.size(); ++i) {
      Eigen::Vector3d& up = survey.stations[i].felt_up->up;
      up = Eigen::AngleAxisd(1.1 * static_cast<double>(i), Eigen::Vector3d::UnitZ()) * up;
    }
    const StationingRun run = survey.run();
    ASSERT_EQ(run.stations.size(), alone.stations.size());
    for (std::size_t i = 0; i < run.stations.size(); ++i) {
      EXPECT_EQ(run.stations[i].position, alone.stations[i].position) << seed << " " << i;
    }
  }
}

/// A point that several stations see is called moved; a wrong sighting of it is not.
TEST(JointSnooping, MovedPointAndWrongSightingAreToldApart) {
  std::size_t moved = 0, mistaken = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    SnoopedSurvey survey(7000 + seed, 7);
    auto point = std::find_if(survey.real.begin(), survey.real.end(), [](const auto& p) { return p.name == "CP9"; });
    point->position += Eigen::Vector3d(3.5e-3, -3e-3, 2e-3);  // 5 mm
    for (std::size_t i = 0; i < survey.stations.size(); ++i) {
      const std::string name = survey.stations[i].name;
      survey.stations[i] = readings(survey.truth[i], survey.real, 7, 1, survey.rng);
      survey.stations[i].name = name;
    }
    spoil(survey.stations[7], "CP15", Fault::direction, 7e-3);
    const auto run = survey.run();
    for (const auto& m : run.moved) (m.name == "CP9" ? moved : mistaken) += 1;
  }
  EXPECT_EQ(moved, 20u);
  EXPECT_EQ(mistaken, 0u);
}

/// By itself a station misses no blunder of twice what it calls detectable.
TEST(JointSnooping, AloneNothingTwiceTheDetectableSizeIsMissed) {
  int tried = 0, weak = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 rng(9000 + seed);
    const auto nominal = pairs_along(360.0, rng);
    const auto real = real_places(nominal, rng);
    const Truth truth = trolley(170.0, rng);
    Stationing s = readings(truth, real, 5, 1, rng);
    const auto network = *ControlNetwork::create(nominal);
    const auto clean = free_station(*reduce(s, {}), network, {}, {});
    ASSERT_TRUE(clean);
    const TargetResult& t = clean->targets[seed % clean->targets.size()];
    const double detectable = t.detectable[static_cast<int>(Fault::distance)];
    if (!(2.0 * detectable < 0.03)) {
      ++weak;
      continue;
    }
    ++tried;
    spoil(s, t.point, Fault::distance, 2.0 * detectable);
    const auto r = free_station(*reduce(s, {}), network, {}, {});
    ASSERT_TRUE(r);
    // Found: left out, or (when another explains the same) somebody is.
    EXPECT_FALSE(r->excluded.empty()) << "seed " << seed << ", detectable " << detectable * 1e3 << " mm";
  }
  EXPECT_GT(tried, 150);
  std::printf("%d tried, %d too weak to be checked\n", tried, weak);
}

}  // namespace
}  // namespace versine::stationing
