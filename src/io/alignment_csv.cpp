// SPDX-License-Identifier: Apache-2.0
#include "versine/io/alignment_csv.hpp"

#include <cmath>

#include "text_output.hpp"
#include "versine/core/numbers.hpp"

namespace versine::io {
namespace {

double radius(double curvature) {
  return curvature == 0.0 ? nan : 1.0 / curvature;
}

void cell(TextOutput& out, double value, int decimals) {
  out.text(",");
  out.number(value, decimals);
}

void place(TextOutput& out, const design::Alignment& a, const char* part, double distance, double length,
           std::string_view shape) {
  // Just inside both ends: there a chainage equation belongs to the element.
  out.print("{},{:.3f},{:.3f},{:.3f},{:.3f},{}", part, distance, a.mileage(distance + 1e-6),
            a.mileage(distance + length - 1e-6), length, shape);
}

std::string_view name_of(design::VerticalElement::Shape shape) {
  switch (shape) {
    case design::VerticalElement::Shape::gradient:
      return "gradient";
    case design::VerticalElement::Shape::parabola:
      return "parabola";
    case design::VerticalElement::Shape::circle:
      return "circle";
  }
  return "gradient";
}

}  // namespace

Expected<void> write_alignment_csv(const std::filesystem::path& path, const design::Alignment& a) {
  TextOutput out(path);
  out.print(
      "# design: {}\n"
      "part,start_distance_m,start_m,end_m,length_m,shape,radius_start_m,radius_end_m,cant_start_mm,cant_end_mm,"
      "easting_m,northing_m,height_m,gradient_start_permille,gradient_end_permille\n",
      a.name);
  for (const auto& placed : a.horizontal.elements()) {
    const auto& e = placed.element;
    const double from = placed.distance, to = from + e.length;
    place(out, a, "horizontal", from, e.length, design::to_string(e.shape));
    cell(out, radius(e.curvature_start), 3);
    cell(out, radius(e.curvature_end), 3);
    cell(out, 1e3 * a.cant.at(from + 1e-6).cant, 2);
    cell(out, 1e3 * a.cant.at(to - 1e-6).cant, 2);
    cell(out, placed.start.easting, 4);
    cell(out, placed.start.northing, 4);
    cell(out, a.profile.at(from).height, 4);
    out.text(",,\n");
  }
  for (const auto& e : a.profile.elements()) {
    place(out, a, "vertical", e.distance, e.length, name_of(e.shape));
    const double bend = e.length > 0.0 ? (e.gradient_end - e.gradient_start) / e.length : 0.0;
    cell(out, radius(bend), 1);
    cell(out, radius(bend), 1);
    out.text(",,,,");
    cell(out, e.height, 4);
    cell(out, 1e3 * e.gradient_start, 4);
    cell(out, 1e3 * e.gradient_end, 4);
    out.end_line();
  }
  return out.close();
}

}  // namespace versine::io
