// SPDX-License-Identifier: Apache-2.0
#include "versine/io/common_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "text_output.hpp"
#include "versine/io/table_reader.hpp"

namespace versine::io {

Expected<CommonPoints> read_common_points(const TableFile& file) {
  auto lines = LineReader::open(file.path);
  if (!lines) return tl::unexpected(lines.error());
  auto opened = TableReader::open(std::move(*lines), file);
  if (!opened) return tl::unexpected(opened.error());
  TableReader& table = *opened;
  constexpr std::array<const char*, 7> names = {"easting",          "northing",       "height", "project_easting",
                                                "project_northing", "project_height", "sigma"};
  std::array<std::optional<TableReader::Slot>, 7> slots;
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto found = table.find(names[i], Quantity::length);
    if (!found) return tl::unexpected(found.error());
    slots[i] = *found;
  }
  const auto name = table.find_text("name");
  CommonPoints out;
  while (table.next()) {
    std::array<double, 7> x{};
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = slots[i] ? table.number(*slots[i]) : std::nan("");
    const std::string label = name ? std::string(table.text(*name)) : fmt::format("line {}", table.line_number());
    const double sigma = x[6] > 0.0 ? x[6] : 1e-3;
    const auto given = [&](std::size_t i) { return std::isfinite(x[i]); };
    const int plane = given(0) + given(1) + given(3) + given(4), heights = given(2) + given(5);
    if ((plane != 0 && plane != 4 && !(plane == 2 && given(0) && given(1))) || (heights == 1 && plane == 0) ||
        (plane == 0 && heights == 0)) {
      return fail({.file = table.name(),
                   .line = table.line_number(),
                   .field = label,
                   .found = "coordinates in one of both systems only",
                   .expected = "easting and northing in both, heights in both, or all of them",
                   .advice = "complete the line or take it out"});
    }
    if (plane == 4) {
      out.plane.push_back(
          {label, {x[0], x[1], heights == 2 ? x[2] : 0.0}, {x[3], x[4], heights == 2 ? x[5] : 0.0}, sigma});
    }
    if (heights == 2) out.height.push_back({label, x[0], x[1], x[2], x[5], sigma});
  }
  if (table.error()) return fail(*table.error());
  return out;
}

Expected<void> write_common_points_csv(const std::filesystem::path& path, const geodesy::Similarity* similarity,
                                       const geodesy::HeightDatum& heights,
                                       const std::vector<geodesy::HeightPoint>& points) {
  TextOutput out(path);
  out.text("name,what,residual_east_mm,residual_north_mm,residual_up_mm,normalized,left_out\n");
  if (similarity != nullptr) {
    for (const auto& r : similarity->residuals) {
      out.print("{},similarity,{:.2f},{:.2f},{:.2f},{:.2f},{}\n", r.name, 1e3 * r.residual.x(), 1e3 * r.residual.y(),
                1e3 * r.residual.z(), r.normalized, r.outlying ? "yes" : "no");
    }
  }
  const auto& bad = heights.outlying();
  for (std::size_t i = 0; i < std::min(points.size(), heights.residuals().size()); ++i) {
    const bool suspect = std::find(bad.begin(), bad.end(), points[i].name) != bad.end();
    out.print("{},height,,,{:.2f},,{}\n", points[i].name, 1e3 * heights.residuals()[i], suspect ? "suspect" : "no");
  }
  return out.close();
}

}  // namespace versine::io
