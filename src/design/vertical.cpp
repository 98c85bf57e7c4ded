// SPDX-License-Identifier: Apache-2.0
#include "versine/design/vertical.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace versine::design {

namespace {

using Curve = VerticalPoint::Curve;

double sine_of(double gradient) {
  return gradient / std::sqrt(1.0 + gradient * gradient);
}

/// Distance from the intersection to where the curve begins (first) and ends (second), m.
/// A circle touches both gradients at equal slope distances, R tan(turn / 2), so its two horizontal parts differ.
struct Extent {
  double before = 0.0, after = 0.0;
};
Extent extent(const VerticalPoint& p, double g1, double g2) {
  if (p.curve == Curve::none || g1 == g2) return {};
  if (p.curve == Curve::parabola) {
    const double half = 0.5 * (p.length > 0.0 ? p.length : p.radius * std::abs(g2 - g1));
    return {half, half};
  }
  const double a1 = std::atan(g1), a2 = std::atan(g2);
  const double chord = std::abs(std::sin(a2) - std::sin(a1));
  const double radius = p.length > 0.0 ? p.length / chord : p.radius;
  const double tangent = radius * std::tan(0.5 * std::abs(a2 - a1));
  return {tangent * std::cos(a1), tangent * std::cos(a2)};
}

Error refuse(const VerticalPoint& p, std::size_t index, std::string found, std::string expected) {
  return {.field =
              fmt::format("profile point {}{}{} at {:.3f} m", index + 1, p.name.empty() ? "" : " ", p.name, p.distance),
          .found = std::move(found),
          .expected = std::move(expected),
          .advice = "mend the profile in the design"};
}

Expected<void> check(const std::vector<VerticalPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VerticalPoint& p = points[i];
    if (!std::isfinite(p.distance) || !std::isfinite(p.height)) {
      return fail(refuse(p, i, fmt::format("distance {}, height {}", p.distance, p.height), "finite numbers"));
    }
    if (i > 0 && !(p.distance > points[i - 1].distance)) {
      return fail(refuse(p, i, fmt::format("{:.3f} m after {:.3f} m", p.distance, points[i - 1].distance),
                         "a distance that increases"));
    }
    if (p.curve != Curve::none && !(p.length > 0.0 && std::isfinite(p.length)) &&
        !(p.radius > 0.0 && std::isfinite(p.radius))) {
      return fail(refuse(p, i, fmt::format("a curve of length {} and radius {}", p.length, p.radius),
                         "a positive length or radius"));
    }
  }
  return {};
}

}  // namespace

Expected<Profile> Profile::from_points(std::vector<VerticalPoint> points) {
  if (points.size() < 2) {
    return fail({.field = "profile", .found = fmt::format("{} point(s)", points.size()), .expected = "two or more"});
  }
  if (auto good = check(points); !good) return tl::unexpected(good.error());
  const std::size_t n = points.size();
  std::vector<double> gradient(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    gradient[i] = (points[i + 1].height - points[i].height) / (points[i + 1].distance - points[i].distance);
  }
  Profile profile;
  double distance = points[0].distance, height = points[0].height;
  const auto append = [&](VerticalElement::Shape shape, double to, double g1, double g2, double end_height) {
    if (to > distance) profile.elements_.push_back({shape, distance, to - distance, height, g1, g2});
    distance = to;
    height = end_height;
  };
  for (std::size_t i = 1; i < n; ++i) {
    const double g1 = gradient[i - 1];
    const VerticalPoint& p = points[i];
    const Extent e = i + 1 < n ? extent(p, g1, gradient[i]) : Extent{};
    const double start = p.distance - e.before;
    if (start < distance - 1e-3) {
      return fail(refuse(p, i,
                         fmt::format("a curve from {:.3f} m that begins inside the one before, which ends at "
                                     "{:.3f} m",
                                     start, distance),
                         "room for both curves"));
    }
    if (i + 1 < n && p.distance + e.after > points[i + 1].distance + 1e-3) {
      return fail(refuse(p, i, fmt::format("a curve that ends at {:.3f} m", p.distance + e.after),
                         fmt::format("its end before the next point at {:.3f} m", points[i + 1].distance)));
    }
    append(VerticalElement::Shape::gradient, start, g1, g1, p.height - g1 * e.before);
    if (e.before > 0.0) {
      append(p.curve == Curve::parabola ? VerticalElement::Shape::parabola : VerticalElement::Shape::circle,
             p.distance + e.after, g1, gradient[i], p.height + gradient[i] * e.after);
    }
  }
  profile.points_ = std::move(points);
  return profile;
}

Profile Profile::constant(double distance, double height, double gradient, double length) {
  Profile profile;
  profile.points_ = {{.distance = distance, .height = height},
                     {.distance = distance + length, .height = height + gradient * length}};
  profile.elements_ = {{VerticalElement::Shape::gradient, distance, length, height, gradient, gradient}};
  return profile;
}

VerticalPose Profile::at(double distance) const {
  if (elements_.empty()) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  const auto after = std::upper_bound(elements_.begin() + 1, elements_.end(), distance,
                                      [](double d, const VerticalElement& e) { return d < e.distance; });
  const VerticalElement& e = *(after - 1);
  const double u = distance - e.distance;
  const bool inside = u >= 0.0 && u <= e.length;
  if (u < 0.0) return {e.height + e.gradient_start * u, e.gradient_start, 0.0};
  const double v = inside ? u : e.length;
  VerticalPose out;
  if (e.shape == VerticalElement::Shape::circle) {
    const double s1 = sine_of(e.gradient_start), s2 = sine_of(e.gradient_end);
    const double k = (s2 - s1) / e.length;  // signed curvature of the circle
    const double s = s1 + k * v;
    const double c1 = std::sqrt(1.0 - s1 * s1), c = std::sqrt(1.0 - s * s);
    // (c1 - c) / k = v (s1 + s) / (c1 + c), without cancellation
    out = {e.height + v * (s1 + s) / (c1 + c), s / c, k / (c * c * c)};
  } else {
    const double k = (e.gradient_end - e.gradient_start) / e.length;
    out = {e.height + v * (e.gradient_start + 0.5 * k * v), e.gradient_start + k * v, k};
  }
  if (!inside) out = {out.height + out.gradient * (u - v), out.gradient, 0.0};
  return out;
}

}  // namespace versine::design
