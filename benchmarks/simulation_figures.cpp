// SPDX-License-Identifier: Apache-2.0
// Draws what docs/simulation.md shows: Allan deviations and spectra of simulated sensors and track against what was
// asked for. versine_simulation_figures FOLDER
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>

#include "versine/core/units.hpp"
#include "versine/report/figure.hpp"
#include "versine/sensors/imu_grade.hpp"
#include "versine/simulation/allan.hpp"
#include "versine/simulation/imu.hpp"
#include "versine/simulation/irregularity.hpp"
#include "versine/simulation/power_density.hpp"

namespace {
using namespace versine;

/// Curve of one triad's first axis, standing for a day and a half at 20 Hz, and what its data sheet says.
report::Figure allan_figure(const sensors::ImuGrade& grade, bool gyro) {
  const double rate = 20.0, step = 1.0 / rate;
  const std::size_t count = 2'592'000;
  sensors::ImuSeries still;
  still.interval = Duration::from_seconds(step);
  still.samples.reserve(count);
  for (std::size_t k = 1; k <= count; ++k) still.samples.push_back({Time{still.interval.ns * static_cast<long>(k)}});
  simulation::Truth truth;
  const auto imu = simulation::with_errors(
      still, {.rate = rate, .errors = grade.errors, .instability = simulation::ImuModel::Instability::flicker}, {},
      [](double) { return 0.0; }, Time{}, 5, truth);
  std::vector<double> increments;
  increments.reserve(count);
  for (const auto& s : imu) increments.push_back(gyro ? s.dtheta.x() : s.dvel.x());
  const auto& triad = gyro ? grade.errors.gyro : grade.errors.accelerometer;
  const double unit = gyro ? units::deg_per_hour : units::mGal;
  report::Figure f;
  f.title = std::string(grade.name) + (gyro ? ", gyro" : ", accelerometer");
  f.x = {.label = "averaging time, s", .logarithmic = true};
  f.y = {.label = gyro ? "Allan deviation, deg/h" : "Allan deviation, mGal", .logarithmic = true};
  report::Curve found{.name = "simulated", .style = report::CurveStyle::points}, walk{.name = "random walk"},
      floor{.name = "instability", .style = report::CurveStyle::dashed};
  for (const auto& p : simulation::allan_deviation(increments, step)) {
    if (p.tau > 0.03 * static_cast<double>(count) * step) continue;
    found.x.push_back(p.tau), found.y.push_back(p.deviation / unit);
    walk.x.push_back(p.tau), walk.y.push_back(triad.random_walk / std::sqrt(p.tau) / unit);
    floor.x.push_back(p.tau);
    floor.y.push_back(triad.bias_instability * std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi) / unit);
  }
  f.curves = {found, walk, floor};
  f.width = 111, f.height = 79;
  return f;
}

report::Figure spectrum_figure(simulation::Spectrum spectrum, std::string_view name) {
  using simulation::Irregularity;
  const double step = 0.25;
  const std::size_t piece = 2048;
  report::Figure f;
  f.title = name;
  f.x = {.label = "spatial frequency, 1/m", .low = 0.005, .high = 0.5, .logarithmic = true};
  f.y = {.label = "density, mm^2 m", .logarithmic = true};
  int colour = 0;
  for (const auto& [kind, label] : {std::pair{Irregularity::level, "level"},
                                    {Irregularity::alignment, "alignment"},
                                    {Irregularity::cross_level, "cross level"},
                                    {Irregularity::gauge, "gauge"}}) {
    const auto track = simulation::synthesize(spectrum, kind, step, 400'000, 2.0, 150.0, 5);
    const auto density = simulation::power_density(track, step, piece);
    report::Curve found{.name = label, .style = report::CurveStyle::points, .colour = colour};
    report::Curve asked{.style = report::CurveStyle::line, .colour = colour++};
    double next = 0.0;
    for (std::size_t k = 4; k < density.size(); ++k) {
      const double frequency = static_cast<double>(k) / (step * static_cast<double>(piece));
      if (frequency > 0.4) break;
      if (frequency < next) continue;  // evenly spaced on the logarithmic axis
      next = 1.05 * frequency;
      found.x.push_back(frequency), found.y.push_back(1e6 * density[k]);
      asked.x.push_back(frequency);
      asked.y.push_back(1e6 * simulation::spectral_density(spectrum, kind, frequency));
    }
    f.curves.push_back(asked);
    f.curves.push_back(found);
  }
  f.width = 111, f.height = 85;
  return f;
}

bool write(const std::filesystem::path& path, std::span<const report::Figure> panels) {
  std::ofstream out(path, std::ios::binary);
  out << report::to_svg(panels, 2);
  if (!out.flush()) std::cerr << "cannot write " << path << '\n';
  return static_cast<bool>(out);
}
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "versine_simulation_figures FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  std::vector<report::Figure> allan, spectra;
  for (const char* name : {"navigation-rlg", "fog", "tactical", "mems"}) {
    const auto grade = sensors::find_imu_grade(name);
    if (!grade) return 1;
    for (const bool gyro : {true, false}) allan.push_back(allan_figure(*grade, gyro));
  }
  for (const auto& [name, spectrum] : simulation::spectrum_names()) {
    if (spectrum != simulation::Spectrum::none) spectra.push_back(spectrum_figure(spectrum, name));
  }
  return write(folder / "simulation-allan.svg", allan) && write(folder / "simulation-spectra.svg", spectra) ? 0 : 1;
}
