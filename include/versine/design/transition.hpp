// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace versine::design {

/// How curvature (or cant) goes from one value to the next along an element, with `xi = s / length` in [0, 1]:
/// `curvature = k1 + (k2 - k1) f(xi)`. docs/alignment.md lists the formulas and their sources.
enum class Shape {
  line,            ///< no curvature; a cant that does not change
  arc,             ///< constant curvature; a cant that does not change
  clothoid,        ///< f = xi; a straight cant ramp
  helmert,         ///< f = 2 xi^2, then 1 - 2 (1 - xi)^2: Helmert, Schramm, "S-form", biquadratic parabola
  bloss,           ///< f = xi^2 (3 - 2 xi)
  cosine,          ///< f = (1 - cos(pi xi)) / 2
  sine,            ///< f = xi - sin(2 pi xi) / (2 pi): Klein
  viennese,        ///< f of degree 7, plus a term from the cant (Hasslinger, Wiener Bogen)
  cubic_parabola,  ///< y = x^3 / (6 R L): curvature follows abscissa, not arc length. As a cant ramp: f = xi
};

[[nodiscard]] constexpr bool is_transition(Shape shape) {
  return shape != Shape::line && shape != Shape::arc;
}
/// "clothoid", "Bloss", ...
[[nodiscard]] std::string_view to_string(Shape shape);

/// f, its derivative and its integral from 0, at xi in [0, 1]. Exact; `cubic_parabola` as `clothoid`.
/// For line and arc all three are zero.
[[nodiscard]] double ramp(Shape shape, double xi);
[[nodiscard]] double ramp_rate(Shape shape, double xi);
[[nodiscard]] double ramp_integral(Shape shape, double xi);

}  // namespace versine::design
