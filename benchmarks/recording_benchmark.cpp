// SPDX-License-Identifier: Apache-2.0
// Reading an IMU file: rows per second, plain and zstd, and writing a trajectory as text.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "versine/io/read_recording.hpp"
#include "versine/io/write_trajectory.hpp"

namespace {
namespace fs = std::filesystem;
constexpr std::size_t rows = 720'000;  // one hour at 200 Hz

/// Made once, removed at the end.
struct TemporaryFile {
  fs::path path;
  ~TemporaryFile() { fs::remove(path); }
};

const fs::path& imu_file() {
  static const TemporaryFile file{[] {
    const fs::path made = fs::temp_directory_path() / "versine_benchmark_imu.csv";
    std::ofstream out(made);
    out << "time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n";
    char line[160];
    for (std::size_t i = 0; i < rows; ++i) {
      const double t = 0.005 * static_cast<double>(i);
      std::snprintf(line, sizeof line, "%.3f,%.9f,%.9f,%.9f,%.7f,%.7f,%.7f\n", 1436038476.0 + t, 1e-3 * std::sin(t),
                    -2e-3 * std::cos(3 * t), 0.1 * std::sin(0.1 * t), std::sin(7 * t), std::cos(5 * t),
                    -9.81 + 0.1 * std::sin(t));
      out << line;
    }
    return made;
  }()};
  return file.path;
}

void read_imu(benchmark::State& state) {
  versine::io::ImuFile file;
  file.table.path = imu_file();
  for (auto _ : state) {
    const auto read = versine::io::read_imu(file);
    if (!read || read->series.size() != rows) state.SkipWithError("not read");
    benchmark::DoNotOptimize(read);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(rows) * state.iterations());
}
BENCHMARK(read_imu)->Unit(benchmark::kMillisecond);

void write_trajectory(benchmark::State& state) {
  versine::geodesy::Trajectory trajectory;
  for (std::int64_t i = 0; i < 200'000; ++i) {
    const double t = 0.005 * static_cast<double>(i);
    versine::geodesy::TrajectoryPoint p{
        .time = {i * 5'000'000}, .position = {0.9 + 1e-9 * t, 0.2, 100.0}, .v_eb_n = {std::sin(t), 1.0, 0.0}};
    p.position_covariance = p.velocity_covariance = p.attitude_covariance = {.xx = 1e-4f, .yy = 1e-4f, .zz = 1e-4f};
    trajectory.samples.push_back(p);
  }
  const fs::path path = fs::temp_directory_path() / "versine_benchmark_trajectory.csv";
  for (auto _ : state) {
    if (!versine::io::write_trajectory_csv(path, trajectory)) state.SkipWithError("not written");
  }
  state.SetItemsProcessed(200'000 * state.iterations());
  fs::remove(path);
}
BENCHMARK(write_trajectory)->Unit(benchmark::kMillisecond);
}  // namespace
