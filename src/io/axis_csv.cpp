// SPDX-License-Identifier: Apache-2.0
#include "versine/io/axis_csv.hpp"

#include <cmath>

#include "text_output.hpp"
#include "versine/core/numbers.hpp"

namespace versine::io {
namespace {

/// A number and its standard deviation; both empty where there is none.
void pair(TextOutput& out, double value, double sigma, int decimals) {
  out.text(",");
  out.number(value, decimals);
  out.text(",");
  out.number(std::isfinite(value) ? sigma : nan, decimals);
}

}  // namespace

Expected<void> write_axis_csv(const std::filesystem::path& path, const design::OptimalAxis& axis) {
  TextOutput out(path);
  const design::Alignment& a = axis.alignment;
  out.print(
      "# axis: {}\n# sigma: standard deviation; 0: not estimated\n# radius, cant: positive in a right-hand curve, left "
      "rail higher\n# kind_certain: the data tell the kind of transition; else it is the usual one\n# profile: a row "
      "for "
      "each gradient, with the place of the intersection it begins at and the length of the curve there\n"
      "part,element,kind,distance_m,sigma_distance_m,length_m,sigma_length_m,radius_m,sigma_radius_m,cant_mm,"
      "sigma_cant_mm,gradient_permille,sigma_gradient_permille,mileage_m,kind_certain\n",
      a.name);
  const auto& elements = a.horizontal.elements();
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto& e = elements[i].element;
    const design::ElementSigma& s = axis.sigma[i];
    const bool transition = design::is_transition(e.shape), curved = !transition && e.curvature_start != 0.0;
    const double middle = elements[i].distance + 0.5 * e.length;
    out.print("horizontal,{},{}", i + 1, design::to_string(e.shape));
    pair(out, elements[i].distance, s.joint, 3);
    pair(out, e.length, s.length, 3);
    pair(out, curved ? 1.0 / e.curvature_start : nan, s.curvature / std::pow(e.curvature_start, 2), 3);
    pair(out, transition || a.cant.empty() ? nan : 1e3 * a.cant.at(middle).cant, 1e3 * s.cant, 2);
    out.print(",,,{:.3f},{}\n", a.mileage(elements[i].distance), transition ? (s.kind_certain ? "yes" : "no") : "");
  }
  const auto& points = a.profile.points();
  for (std::size_t i = 0; i + 1 < points.size() && i < axis.gradient_sigma.size(); ++i) {
    const design::GradientSigma& s = axis.gradient_sigma[i];
    const double slope = (points[i + 1].height - points[i].height) / (points[i + 1].distance - points[i].distance);
    out.print("profile,{},gradient", i + 1);
    pair(out, points[i].distance, s.place, 3);
    pair(out, points[i].length, s.curve, 3);
    out.text(",,,,");
    pair(out, 1e3 * slope, 1e3 * s.gradient, 4);
    out.print(",{:.3f},\n", a.mileage(points[i].distance));
  }
  return out.close();
}

}  // namespace versine::io
