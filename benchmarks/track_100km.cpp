// SPDX-License-Identifier: Apache-2.0
// 100 km of track at 0.25 m: seconds and memory from trajectory to files. versine_track_100km [KM]
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "track/test_run.hpp"
#include "versine/app/geometry.hpp"

using namespace versine;

namespace {
double cpu() {
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  return double(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-6 * double(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}
double megabytes() {
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  return double(u.ru_maxrss) / 1024.0;
}

design::Alignment line(double km) {
  using namespace design;
  const double inf = std::numeric_limits<double>::infinity();
  std::vector<HorizontalElement> elements;
  std::vector<CantPoint> cant = {{0, 0}};
  double s = 0.0;
  for (int k = 0; s < km * 1000 + 200; ++k) {
    const double r = k % 2 == 0 ? 1500.0 : -1200.0, c = k % 2 == 0 ? 0.08 : -0.09;
    for (const auto& e : {design::line(600), transition(Shape::clothoid, 120, inf, r), arc(500, r),
                          transition(Shape::clothoid, 120, r, inf)}) {
      elements.push_back(e);
    }
    cant.push_back({s + 600, 0});
    cant.push_back({s + 720, c});
    cant.push_back({s + 1220, c});
    cant.push_back({s + 1340, 0});
    s += 1340;
  }
  return {.horizontal = *HorizontalAxis::chain({400000.0, 5500000.0, 0.6}, elements),
          .profile = Profile::constant(0.0, 120.0, 0.0005, s),
          .cant = *CantProfile::from_points(cant),
          .chainage = {},
          .name = "100 km",
          .crs = "EPSG:25832"};
}
}  // namespace

int main(int argc, char** argv) {
  const double km = argc > 1 ? std::atof(argv[1]) : 100.0;
  track::test::Track track{line(km)};
  track.lateral = [](double s) { return 0.002 * std::sin(s / 2.1) + 0.003 * std::sin(s / 7.0); };
  track.vertical = [](double s) { return 0.002 * std::sin(s / 1.7) + 0.004 * std::sin(s / 9.0); };
  const auto projection = *geodesy::Projection::create("EPSG:25832");
  auto run = track::test::Builder(track, projection).run(10.0, km * 1000 + 10.0, 0.25);
  filter::ErrorChain chain;
  const Eigen::MatrixXf A = 0.99999f * Eigen::MatrixXf::Identity(22, 22), P = 1e-6f * Eigen::MatrixXf::Identity(22, 22);
  for (std::size_t i = 0; i < run.trajectory.size(); i += 8) {
    chain.push_back(run.trajectory[i].time, P, i + 8 < run.trajectory.size() ? A : Eigen::MatrixXf());
  }
  const double input_mb = megabytes(), start = cpu();
  const auto wall = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count(); };
  track::GeometryInput input;
  input.trajectory = &run.trajectory;
  input.chain = &chain;
  input.gauge = std::move(run.gauge);
  input.design = &track.design;
  SilentProgress progress;
  auto g = track::compute_geometry(input, {}, progress);
  if (!g) return std::printf("%s\n", g.error().message().c_str()), 1;
  const double computed = cpu();
  const auto limits = app::read_limits(VERSINE_SOURCE "/data/limits/en13848-5.toml");
  if (!limits) return std::printf("%s\n", limits.error().message().c_str()), 1;
  const auto quality = track::assess(*g, *limits, 160 / 3.6);
  const double assessed = cpu();
  const double before_files = seconds();
  app::GeometryResult result;
  result.geometry = std::move(*g);
  result.quality = std::move(*quality);
  const auto target = std::filesystem::temp_directory_path() / "versine_track_100km";
  auto folder = io::ResultFolder::create(target);
  if (!folder) return std::printf("%s\n", folder.error().message().c_str()), 1;
  if (const auto done = app::write_track_geometry({}, result, *folder, progress); !done)
    return std::printf("%s\n", done.error().message().c_str()), 1;
  const double written = cpu();
  const std::vector<std::pair<const char*, double>> times = {
      {"compute", computed - start}, {"quality", assessed - computed}, {"files", written - assessed}};
  std::printf("%zu points, %zu columns, %zu exceedances\n", result.geometry.size(), result.geometry.columns.size(),
              result.quality->exceedances.size());
  for (const auto& [name, t] : times) std::printf("  %-8s %6.2f s of CPU\n", name, t);
  std::printf("  files took %.2f s of wall time\n", seconds() - before_files);
  std::printf("CPU %.2f s, wall %.2f s, peak memory %.0f MB (%.0f MB of it input)\n", cpu() - start, seconds(),
              megabytes(), input_mb);
  return 0;
}
