// SPDX-License-Identifier: Apache-2.0
#include "versine/app/measured_axis.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "versine/io/axis_csv.hpp"
#include "versine/io/geometry_table.hpp"
#include "versine/io/landxml.hpp"

namespace versine::app {

namespace {

/// Columns of the axis, by grid point.
struct AxisColumns {
  const std::vector<double>&distance, &easting, &northing, &height, &cross_level;
};

std::vector<design::TrackSample> samples_of(const AxisColumns& c) {
  std::vector<design::TrackSample> out;
  const std::size_t n = c.distance.size();
  if (n < 3) return out;
  const double step = (c.distance.back() - c.distance.front()) / static_cast<double>(n - 1);
  const auto reach = static_cast<std::size_t>(std::max(1.0, std::round(1.0 / step)));
  for (std::size_t i = reach; i + reach < n; i += reach) {
    const double de = c.easting[i + reach] - c.easting[i - reach], dn = c.northing[i + reach] - c.northing[i - reach];
    if (std::isfinite(de) && std::isfinite(c.easting[i]) && std::isfinite(c.height[i]) &&
        std::isfinite(c.cross_level[i])) {
      out.push_back({c.distance[i], c.easting[i], c.northing[i], std::atan2(de, dn), c.height[i], c.cross_level[i]});
    }
  }
  return out;
}

/// The CRS that run.json of the result names; empty when it names none.
std::string crs_of(const std::filesystem::path& result) {
  std::ifstream file(result / "run.json");
  const auto run = nlohmann::json::parse(file, nullptr, false);
  if (run.is_discarded()) return {};
  for (const auto* at : {"/results/geometry/crs", "/results/crs"}) {
    const nlohmann::json::json_pointer pointer(at);
    if (run.contains(pointer) && run[pointer].is_string()) return run[pointer].get<std::string>();
  }
  return {};
}

std::string text_of(const design::OptimalAxis& axis) {
  std::string text = fmt::format(
      "{} horizontal elements, {} gradients; the track lies {:.2f} mm RMS beside, {:.2f} mm "
      "above or below\n",
      axis.alignment.horizontal.elements().size(), axis.gradient_sigma.size(), 1e3 * axis.offset_rms,
      1e3 * axis.height_rms);
  for (std::size_t i = 0; i < axis.sigma.size(); ++i) {
    const auto& placed = axis.alignment.horizontal.elements()[i];
    const auto& e = placed.element;
    text += fmt::format("  {:10.2f} m ± {:.2f}  {:10} {:8.2f} m", axis.alignment.mileage(placed.distance),
                        axis.sigma[i].joint, design::to_string(e.shape), e.length);
    if (e.shape == design::Shape::arc) {
      text += fmt::format("  R {:9.2f} m ± {:.2f}", 1.0 / e.curvature_start,
                          axis.sigma[i].curvature / std::pow(e.curvature_start, 2));
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::vector<design::TrackSample> axis_samples(const track::Geometry& g) {
  return samples_of({g.mileage, g.at("easting_axis").value, g.at("northing_axis").value, g.at("height_axis").value,
                     g.at("cross_level").value});
}

Expected<AxisRun> run_axis(const AxisRequest& request) {
  const auto table = io::GeometryTable::open(request.result / "geometry.csv");
  if (!table) return tl::unexpected(table.error());
  const std::vector<std::string> names = {"distance_m",      "mileage_m",     "easting_axis_m",
                                          "northing_axis_m", "height_axis_m", "cross_level_mm"};
  for (const auto& name : names) {
    if (table->has(name)) continue;
    return fail({.file = (request.result / "geometry.csv").string(),
                 .field = name,
                 .found = "no such column",
                 .expected = "the geometry.csv of a survey or geometry job",
                 .advice = "name the folder of a result with track geometry"});
  }
  auto columns = table->read(names);
  if (!columns) return tl::unexpected(columns.error());
  for (double& c : (*columns)[5]) c *= 1e-3;
  const auto samples = samples_of({(*columns)[0], (*columns)[2], (*columns)[3], (*columns)[4], (*columns)[5]});
  auto axis = design::optimal_axis(samples, request.options);
  if (!axis) {
    Error error = axis.error();
    error.file = (request.result / "geometry.csv").string();
    return tl::unexpected(error);
  }
  axis->alignment.crs = crs_of(request.result);
  // The axis counts from its own start, which is at this mileage of the run.
  const auto first = static_cast<std::size_t>(
      std::lower_bound((*columns)[0].begin(), (*columns)[0].end(), samples.front().distance - 1e-6) -
      (*columns)[0].begin());
  axis->alignment.chainage = design::Chainage::offset((*columns)[1][first]);
  AxisRun out{std::move(*axis), request.output, request.output, {}};
  out.table.replace_extension(".csv");
  if (auto done = io::write_landxml(out.landxml, out.axis); !done) return tl::unexpected(done.error());
  if (auto done = io::write_axis_csv(out.table, out.axis); !done) return tl::unexpected(done.error());
  out.text = text_of(out.axis);
  return out;
}

}  // namespace versine::app
