// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "versine/app/simulate_config.hpp"
#include "versine/io/alignment_file.hpp"
#include "versine/io/write_recording.hpp"
#include "versine/simulation/simulate.hpp"

/// From what a scenario file says to a scenario.
namespace versine::app {

namespace {
tl::unexpected<Error> refuse(std::string field, std::string found, std::string expected, std::string advice) {
  return fail({.field = std::move(field),
               .found = std::move(found),
               .expected = std::move(expected),
               .advice = std::move(advice)});
}

double curvature(double radius, ElementConfig::Turn turn) {
  if (radius == 0.0) return 0.0;
  return (turn == ElementConfig::Turn::right ? 1.0 : -1.0) / radius;
}

std::string radius_text(double k) {
  return k == 0.0 ? "a straight" : fmt::format("{:.3f} m", 1.0 / std::abs(k));
}

/// Curvature of a line or arc; nothing for a transition.
Expected<std::optional<double>> fixed_curvature(const ElementConfig& e, std::size_t i) {
  if (e.shape == design::Shape::line) return std::optional(0.0);
  if (e.shape != design::Shape::arc) return std::optional<double>();
  if (!e.radius) {
    return refuse(fmt::format("track.horizontal[{}].radius_m", i), "nothing", "the radius of the arc",
                  "add for example radius_m = 600.0 and turn = \"right\"");
  }
  return std::optional(curvature(*e.radius, e.turn));
}

Expected<std::vector<design::HorizontalElement>> elements_of(const std::vector<ElementConfig>& list) {
  std::vector<std::optional<double>> fixed;
  for (std::size_t i = 0; i < list.size(); ++i) {
    auto k = fixed_curvature(list[i], i);
    if (!k) return tl::unexpected(std::move(k.error()));
    fixed.push_back(*k);
  }
  std::vector<design::HorizontalElement> elements;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const ElementConfig& e = list[i];
    design::HorizontalElement out{.shape = e.shape, .length = e.length};
    if (fixed[i]) {
      out.curvature_start = out.curvature_end = *fixed[i];
      elements.push_back(out);
      continue;
    }
    const std::optional<double> before = elements.empty() ? std::nullopt : std::optional(elements.back().curvature_end);
    const std::optional<double> behind = i + 1 < list.size() ? fixed[i + 1] : std::nullopt;
    const auto end = [&](const std::optional<double>& radius, const std::optional<double>& neighbour,
                         std::string_view key) -> Expected<double> {
      if (!radius) return neighbour.value_or(0.0);
      const double k = curvature(*radius, e.turn);
      if (neighbour && std::abs(k - *neighbour) > 1e-9) {
        return refuse(fmt::format("track.horizontal[{}].{}", i, key),
                      fmt::format("{}, where its neighbour has {}", radius_text(k), radius_text(*neighbour)),
                      "transitions that meet their neighbours",
                      "leave the key out: a transition takes its neighbours' radii");
      }
      return k;
    };
    const auto k1 = end(e.radius_start, before, "start_radius_m");
    if (!k1) return tl::unexpected(k1.error());
    const auto k2 = end(e.radius_end, behind, "end_radius_m");
    if (!k2) return tl::unexpected(k2.error());
    out.curvature_start = *k1, out.curvature_end = *k2;
    elements.push_back(out);
  }
  return elements;
}

Expected<design::Alignment> written_alignment(const SimulateConfig& c) {
  auto elements = elements_of(c.horizontal);
  if (!elements) return tl::unexpected(std::move(elements.error()));
  if (elements->empty()) {
    return refuse("track", "no line", "[[track.horizontal]] elements, or alignment_file",
                  "add for example [[track.horizontal]] type = \"line\" length_m = 1000.0");
  }
  auto axis = design::HorizontalAxis::chain({c.easting, c.northing, c.heading}, std::move(*elements));
  if (!axis) return tl::unexpected(std::move(axis.error()));
  design::Alignment alignment{.horizontal = std::move(*axis)};
  if (!c.vertical.empty()) {
    auto profile = design::Profile::from_points(c.vertical);
    if (!profile) return tl::unexpected(std::move(profile.error()));
    alignment.profile = std::move(*profile);
  }
  if (!c.cant.empty()) {
    auto cant = design::CantProfile::from_points(c.cant);
    if (!cant) return tl::unexpected(std::move(cant.error()));
    alignment.cant = std::move(*cant);
  }
  auto equations = c.chainage;
  equations.insert(equations.begin(), {0.0, c.mileage, true, "start"});
  auto chainage = design::Chainage::from_equations(std::move(equations));
  if (!chainage) return tl::unexpected(std::move(chainage.error()));
  alignment.chainage = std::move(*chainage);
  alignment.name = c.title;
  return alignment;
}

Expected<design::Alignment> alignment_of(const SimulateConfig& c) {
  auto alignment = c.alignment_file.empty()
                       ? written_alignment(c)
                       : io::read_alignment({c.alignment_file.path, c.gradients_file.path, c.stationing_file.path},
                                            c.alignment_name);
  if (alignment && !c.crs.empty()) alignment->crs = c.crs;
  return alignment;
}

}  // namespace

Expected<SimulateConfig> read_simulate_config(const std::filesystem::path& path,
                                              std::span<const std::string> overrides) {
  SimulateConfig c;
  if (auto done = read_config(
          path, [&](ConfigVisitor& v) { describe(v, c); }, overrides);
      !done) {
    return tl::unexpected(std::move(done.error()));
  }
  const auto in_file = [&](Error error) {
    if (error.file.empty()) error.file = path.string();
    return tl::unexpected<Error>(std::move(error));
  };
  auto errors = c.imu_errors.errors();
  if (!errors) {
    Error error = std::move(errors.error());
    error.field = "imu." + error.field;
    return in_file(std::move(error));
  }
  c.imu.errors = *errors;
  if (c.job != "simulate") {
    return in_file({.field = "job",
                    .found = fmt::format("'{}'", c.job),
                    .expected = "\"simulate\"",
                    .advice = "run the file with its own command"});
  }
  if (!c.journey.present) {
    auto alignment = alignment_of(c);
    if (!alignment) return in_file(std::move(alignment.error()));
    c.scenario.track.alignment = std::move(*alignment);
  } else if (c.journey.made == !c.journey.file.empty()) {
    return in_file({.field = "network",
                    .found = c.journey.made ? "both a file and [network.made]" : "neither a file nor [network.made]",
                    .expected = "one of them",
                    .advice = "name the map with 'file', or add [network.made]"});
  }
  if (!c.table_file.empty()) {
    auto table = io::read_deviations(c.table_file.path);
    if (!table) return tl::unexpected(std::move(table.error()));
    c.scenario.track.table = std::move(*table);
  }
  c.scenario.name = c.title;
  c.scenario.start = Time::from_seconds(c.start_gps_s);
  auto& on = c.scenario.equipment;
  if (c.has_vehicle) c.scenario.vehicle = c.vehicle;
  if (c.has_imu) on.imu = c.imu;
  if (c.has_gauge) on.gauge = c.gauge;
  if (c.has_sleeper) on.sleeper = c.sleeper;
  if (c.has_gnss) on.gnss = c.gnss;
  if (c.has_total_station) on.total_station = c.total_station;
  if (c.has_axle_box) on.axle_box = c.axle_box;
  if (c.journey.present) return c;
  if (auto good = simulation::check(c.scenario); !good) return in_file(std::move(good.error()));
  return c;
}

}  // namespace versine::app
