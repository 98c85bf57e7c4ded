// SPDX-License-Identifier: Apache-2.0
#include "versine/app/geometry_coordinates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "versine/app/geometry.hpp"
#include "versine/core/units.hpp"
#include "versine/io/common_points.hpp"

namespace versine::app {

namespace {

using Model = CoordinatesConfig::Model;
using Heights = CoordinatesConfig::Heights;

Error about(const CoordinatesConfig& c, Error error) {
  error.file = c.points.file.written;
  return error;
}

std::vector<std::string> outlying(const CoordinateTie& tie) {
  std::vector<std::string> out = tie.heights.outlying();
  if (!tie.similarity) return out;
  for (const auto& r : tie.similarity->residuals) {
    if (r.outlying && std::find(out.begin(), out.end(), r.name) == out.end()) out.push_back(r.name);
  }
  return out;
}

}  // namespace

Expected<std::optional<CoordinateTie>> tie_coordinates(const CoordinatesConfig& c, track::GeometryInput& input,
                                                       std::vector<io::RunInput>& files) {
  if (c.model == Model::none && c.heights == Heights::none) return std::nullopt;
  if (c.model == Model::space && c.heights != Heights::none) {
    return fail({.field = "geometry.coordinates.heights",
                 .found = "a height datum beside a similarity in space",
                 .expected = "one of both: a similarity in space moves heights too",
                 .advice = "take similarity = \"plane\", or heights = \"none\""});
  }
  CoordinateTie tie;
  io::CommonPoints points;
  if (c.model != Model::none || c.heights == Heights::offset || c.heights == Heights::plane) {
    if (!c.points.given()) {
      return fail({.field = "geometry.coordinates.points",
                   .found = "nothing",
                   .expected = "a file of common points",
                   .advice = "name a CSV with points known in both systems: at least two (three in space)"});
    }
    if (auto done = note_file("common points", c.points.file, files); !done) return tl::unexpected(done.error());
    auto read = io::read_common_points(c.points.description);
    if (!read) return tl::unexpected(read.error());
    points = std::move(*read);
  }
  if (c.model != Model::none) {
    if (c.model == Model::plane) {
      for (auto& p : points.plane) p.source.z() = p.target.z() = 0.0;  // heights are HeightDatum's
    }
    auto fit = geodesy::fit_similarity(points.plane,
                                       {.three_dimensional = c.model == Model::space, .fixed_scale = c.fixed_scale});
    if (!fit) return tl::unexpected(about(c, fit.error()));
    tie.similarity = input.similarity = std::move(*fit);
  }
  if (c.heights != Heights::none) {
    auto datum = c.heights == Heights::geoid    ? geodesy::HeightDatum::geoid(c.geoid)
                 : c.heights == Heights::offset ? geodesy::HeightDatum::offset(points.height)
                                                : geodesy::HeightDatum::plane(points.height);
    if (!datum) return tl::unexpected(c.heights == Heights::geoid ? datum.error() : about(c, datum.error()));
    tie.heights = input.heights = std::move(*datum);
    if (c.heights != Heights::geoid) tie.height_points = std::move(points.height);
    if (input.height_datum == "ellipsoidal") input.height_datum = tie.heights.description();
  }
  return tie;
}

Expected<void> write_tie(const std::filesystem::path& path, const CoordinateTie& tie) {
  return io::write_common_points_csv(path, tie.similarity ? &*tie.similarity : nullptr, tie.heights, tie.height_points);
}

std::string tie_json(const CoordinateTie& tie) {
  nlohmann::ordered_json out;
  if (const auto& s = tie.similarity) {
    out["similarity"] = {{"points", s->residuals.size()},
                         {"scale_ppm", (s->scale - 1.0) * 1e6},
                         {"rotation_deg", s->rotation_z() / units::deg},
                         {"redundancy", s->redundancy}};
    if (s->redundancy > 0) out["similarity"]["sigma0"] = s->sigma0;
  }
  out["heights"] = tie.heights.description();
  out["outlying"] = outlying(tie);
  return out.dump();
}

std::string tie_text(const CoordinateTie& tie) {
  std::string text;
  if (const auto& s = tie.similarity) {
    double worst = 0.0;
    for (const auto& r : s->residuals) worst = r.outlying ? worst : std::max(worst, r.residual.norm());
    text += fmt::format(
        "  project grid: {} common points, scale {:+.2f} ppm, rotation {:.6f} deg, residuals up to {:.1f} mm\n",
        s->residuals.size(), (s->scale - 1.0) * 1e6, s->rotation_z() / units::deg, worst / units::mm);
  }
  if (tie.heights.kind() != geodesy::HeightDatum::Kind::none) {
    text += fmt::format("  heights: {}\n", tie.heights.description());
  }
  for (const auto& name : outlying(tie)) text += fmt::format("  warning: common point {} does not fit\n", name);
  return text;
}

}  // namespace versine::app
