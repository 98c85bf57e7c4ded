// SPDX-License-Identifier: Apache-2.0
/// versine_fleet FOLDER [RECORDINGS [JOURNEYS [axle-box]]]: recordings of vehicles that shuttle about a made railway,
/// for benchmarks/batch_fleet.py: 100 Hz IMU, 5 Hz GNSS with correlated errors, about 84 s a journey, standing
/// included. With `axle-box` a 20 kHz file of the first vehicle's two axle boxes too.
#include <fmt/format.h>
#include <hdf5.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "versine/io/write_journey.hpp"
#include "versine/network/build.hpp"
#include "versine/network/oriented_graph.hpp"
#include "versine/network/path.hpp"
#include "versine/simulation/network_layout.hpp"

namespace {
using namespace versine;
using network::OrientedTrack;

class Vehicle {
 public:
  Vehicle(const network::Network& network, const network::OrientedGraph& graph, unsigned seed)
      : network_(network), graph_(graph), random_(seed), bias_(0.04 * normal_(random_)) {
    recording.gnss.scale = recording.imu.scale = TimeScale::gps;
    recording.imu.interval = Duration{10'000'000};
    time_ = Time{1'400'000'000'000'000'000 + static_cast<std::int64_t>(seed) * 10'000'000'000'000};
    do {
      track_ = OrientedTrack::from_state(
          std::uniform_int_distribution<std::uint32_t>(0, static_cast<std::uint32_t>(graph.states()) - 1)(random_));
    } while (graph.length(track_) < 100.0);
    into_ = 0.5 * graph.length(track_);
  }

  /// To a place some hundred metres on; the other way round where that is nearer to a dead end. Going on in the
  /// direction of the movement before, after a halt, is the same journey.
  void move_on() {
    network::Path path = way();
    const bool round = network::PathCoordinates(network_, path).length() - into_ < 250.0;
    if (round) {
      reverse();
      path = way();
    }
    if (!round || journeys == 0) ++journeys;
    const network::PathCoordinates c(network_, path);
    const double goal = std::min(into_ + 420.0 + 60.0 * normal_(random_), c.length() - 20.0);
    move(c, goal);
    const auto place = c.place(goal);
    track_ = place.track;
    into_ = goal - c.starts()[place.index];
    reverse();
  }

  simulation::SimulatedRecording recording;
  int journeys = 0;

 private:
  void reverse() {
    into_ = graph_.length(track_) - into_;
    track_ = track_.opposite();
  }

  network::Path way() {
    network::Path path{track_};
    double length = graph_.length(track_) - into_;
    for (auto out = graph_.successors(track_); !out.empty() && length < 900.0; out = graph_.successors(path.back())) {
      path.push_back(out[std::uniform_int_distribution<std::size_t>(0, out.size() - 1)(random_)].to);
      length += graph_.length(path.back());
    }
    return path;
  }

  void move(const network::PathCoordinates& c, double goal) {
    double d = into_, v = 0.0;
    for (int k = 0; k < 850; ++k) sample(c, d, 0.0, 0.0);
    while (goal - d > 0.01) {
      const double limit = std::sqrt(2.0 * 0.5 * (goal - d));
      const double a = v > limit ? -0.52 : v < 9.0 ? 0.4 : 0.0;
      sample(c, d, v, a);
      d += 0.01 * v + 0.5e-4 * a;
      v = std::max(0.02, v + 0.01 * a);
    }
    for (int k = 0; k < 850; ++k) sample(c, goal, 0.0, 0.0);
  }

  void sample(const network::PathCoordinates& c, double d, double v, double a) {
    // Whole mm/s^2 and 10 urad/s, as a sensor's digits are.
    const auto digits = [](double x, double unit) { return std::round(x / unit) * unit; };
    const double turn = v > 0.0 ? v * c.curvature(d, 10.0) : 0.0;
    sensors::ImuSample s;
    s.time = time_;
    s.dvel = 0.01 * Eigen::Vector3d(digits(a + bias_ + 0.08 * normal_(random_), 1e-3),
                                    digits(v * turn + 0.08 * normal_(random_), 1e-3),
                                    digits(-9.81 + 0.08 * normal_(random_), 1e-3));
    s.dtheta = 0.01 * Eigen::Vector3d(0.0, 0.0, digits(turn + 0.002 * normal_(random_), 1e-5));
    recording.imu.samples.push_back(s);
    if (count_++ % 20 == 0) fix(c.position(d), v);
    time_ = time_ + Duration{10'000'000};
  }

  void fix(const Eigen::Vector2d& place, double v) {
    const double f = std::exp(-0.2 / 15.0), sigma = 1.0;
    for (int i = 0; i < 2; ++i) colour_[i] = f * colour_[i] + std::sqrt(1.0 - f * f) * normal_(random_);
    const Eigen::Vector2d white(normal_(random_), normal_(random_));
    sensors::GnssSample g;
    g.time = time_;
    g.position = network_.to_geodetic(place + sigma * (std::sqrt(0.8) * colour_ + std::sqrt(0.2) * white));
    g.sigma_ned = Eigen::Vector3d(sigma, sigma, 2.0) / std::sqrt(2.0);
    g.v_ned = Eigen::Vector3d(std::abs(v + 0.1 * normal_(random_)), 0.0, 0.0);
    g.sigma_v_ned = Eigen::Vector3d(0.1, 0.1, 0.1);
    recording.gnss.samples.push_back(g);
  }

  const network::Network& network_;
  const network::OrientedGraph& graph_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double bias_;
  Time time_;
  OrientedTrack track_;
  double into_ = 0.0;
  Eigen::Vector2d colour_{0.0, 0.0};
  std::size_t count_ = 0;
};
/// 16-bit noise of both sides from `from` on, a block at a time.
void write_axle_box(const std::filesystem::path& path, double seconds) {
  const hsize_t size = static_cast<hsize_t>(seconds * 20'000.0), block = 1'000'000;
  std::mt19937 random(7);
  std::vector<std::int16_t> values(block);
  const hid_t file = H5Fcreate(path.string().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  for (const char* name : {"left", "right"}) {
    const hid_t set = H5Dcreate2(file, name, H5T_NATIVE_INT16, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    for (hsize_t from = 0; from < size; from += block) {
      const hsize_t count = std::min(block, size - from);
      for (auto& v : values) v = static_cast<std::int16_t>(random());
      const hid_t memory = H5Screate_simple(1, &count, nullptr);
      H5Sselect_hyperslab(space, H5S_SELECT_SET, &from, nullptr, &count, nullptr);
      H5Dwrite(set, H5T_NATIVE_INT16, memory, space, H5P_DEFAULT, values.data());
      H5Sclose(memory);
    }
    H5Dclose(set);
  }
  H5Sclose(space), H5Fclose(file);
}
}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "versine_fleet FOLDER [RECORDINGS [JOURNEYS [axle-box]]]\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const int recordings = argc > 2 ? std::atoi(argv[2]) : 60, journeys = argc > 3 ? std::atoi(argv[3]) : 100;
  std::filesystem::create_directories(folder / "recordings");
  const auto source = simulation::make_network({.length = 8000.0, .crossovers = 8, .station_tracks = 6});
  const auto network = network::build(source);
  if (!network || !io::write_network_geojson(folder / "network.geojson", source)) return 1;
  const network::OrientedGraph graph(*network);
  double hours = 0.0;
  for (int i = 0; i < recordings; ++i) {
    Vehicle vehicle(*network, graph, static_cast<unsigned>(i + 1));
    while (vehicle.journeys < journeys) vehicle.move_on();
    hours += static_cast<double>(vehicle.recording.imu.size()) / 360'000.0;
    if (argc > 4 && i == 0) {
      const auto& imu = vehicle.recording.imu;
      write_axle_box(folder / "axlebox.h5", (imu.back().time - imu.front().time).seconds());
      fmt::print("axle box from {:.2f} s\n", imu.front().time.seconds());
    }
    const auto path = folder / "recordings" / fmt::format("vehicle_{:03}.h5", i + 1);
    if (const auto done = io::write_onboard(path, vehicle.recording); !done) {
      fmt::print(stderr, "{}\n", done.error().message());
      return 1;
    }
  }
  fmt::print("{} recordings, {} journeys, {:.1f} h, {} tracks\n", recordings, recordings * journeys, hours,
             network->tracks.size());
  return 0;
}
