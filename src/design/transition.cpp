// SPDX-License-Identifier: Apache-2.0
#include "versine/design/transition.hpp"

#include <cmath>
#include <numbers>

namespace versine::design {

namespace {
constexpr double pi = std::numbers::pi;
}

std::string_view to_string(Shape shape) {
  switch (shape) {
    case Shape::line:
      return "line";
    case Shape::arc:
      return "arc";
    case Shape::clothoid:
      return "clothoid";
    case Shape::helmert:
      return "Helmert";
    case Shape::bloss:
      return "Bloss";
    case Shape::cosine:
      return "cosine";
    case Shape::sine:
      return "sine";
    case Shape::viennese:
      return "Viennese bend";
    case Shape::cubic_parabola:
      return "cubic parabola";
  }
  return "line";
}

double ramp(Shape shape, double xi) {
  const double eta = 1.0 - xi;
  switch (shape) {
    case Shape::line:
    case Shape::arc:
      return 0.0;
    case Shape::clothoid:
    case Shape::cubic_parabola:
      return xi;
    case Shape::helmert:
      return xi < 0.5 ? 2.0 * xi * xi : 1.0 - 2.0 * eta * eta;
    case Shape::bloss:
      return xi * xi * (3.0 - 2.0 * xi);
    case Shape::cosine:
      return 0.5 * (1.0 - std::cos(pi * xi));
    case Shape::sine:
      return xi - std::sin(2.0 * pi * xi) / (2.0 * pi);
    case Shape::viennese:
      return xi * xi * xi * xi * (35.0 + xi * (-84.0 + xi * (70.0 - 20.0 * xi)));
  }
  return 0.0;
}

double ramp_rate(Shape shape, double xi) {
  const double eta = 1.0 - xi;
  switch (shape) {
    case Shape::line:
    case Shape::arc:
      return 0.0;
    case Shape::clothoid:
    case Shape::cubic_parabola:
      return 1.0;
    case Shape::helmert:
      return 4.0 * (xi < 0.5 ? xi : eta);
    case Shape::bloss:
      return 6.0 * xi * eta;
    case Shape::cosine:
      return 0.5 * pi * std::sin(pi * xi);
    case Shape::sine:
      return 1.0 - std::cos(2.0 * pi * xi);
    case Shape::viennese:
      return 140.0 * xi * xi * xi * eta * eta * eta;
  }
  return 0.0;
}

double ramp_integral(Shape shape, double xi) {
  const double eta = 1.0 - xi;
  switch (shape) {
    case Shape::line:
    case Shape::arc:
      return 0.0;
    case Shape::clothoid:
    case Shape::cubic_parabola:
      return 0.5 * xi * xi;
    case Shape::helmert:
      return xi < 0.5 ? 2.0 / 3.0 * xi * xi * xi : xi - 0.5 + 2.0 / 3.0 * eta * eta * eta;
    case Shape::bloss:
      return xi * xi * xi * (1.0 - 0.5 * xi);
    case Shape::cosine:
      return 0.5 * (xi - std::sin(pi * xi) / pi);
    case Shape::sine: {
      const double s = std::sin(pi * xi);  // 1 - cos(2 pi xi) = 2 sin^2(pi xi), without cancellation
      return 0.5 * (xi * xi - s * s / (pi * pi));
    }
    case Shape::viennese: {
      const double x2 = xi * xi;
      return x2 * x2 * xi * (7.0 + xi * (-14.0 + xi * (10.0 - 2.5 * xi)));
    }
  }
  return 0.0;
}

}  // namespace versine::design
