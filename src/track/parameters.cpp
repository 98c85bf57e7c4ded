// SPDX-License-Identifier: Apache-2.0
#include "parameters.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "versine/core/numbers.hpp"
#include "versine/track/versine.hpp"

namespace versine::track {
namespace {

constexpr float nanf = std::numeric_limits<float>::quiet_NaN();

double square(double x) {
  return x * x;
}

/// White noise of a contact point: the reference rail is the mean of two wheels.
double contact(const Stage& s, Rail rail) {
  const bool reference = (rail == Rail::left) == s.rails.reference_is_left;
  return s.input.trolley.contact_sigma * (reference ? std::sqrt(0.5) : 1.0);
}

}  // namespace

std::string metres(double x) {
  return fmt::format("{:g}m", x);
}

PointSigma point_sigma(const Stage& s, Rail rail) {
  const Trolley& t = s.input.trolley;
  const Eigen::Matrix3d C_bv = geodesy::to_matrix(t.mounting).transpose();
  const Eigen::Vector3d middle = beam_centre(t, s.options.nominal_gauge);
  const double y = s.run.direction * (rail == Rail::left ? -0.5 : 0.5) * s.options.rail_distance;
  const bool reference = (rail == Rail::left) == s.rails.reference_is_left;
  const Eigen::Vector3d lever = middle + Eigen::Vector3d(0.0, y, 0.0);
  const geodesy::Euler& m = t.mounting_sigma;
  // Mounting errors turn the lever arm about the trolley's axes.
  const double mount_lateral = square(m.roll * lever.z()) + square(m.yaw * lever.x());
  const double mount_vertical = square(m.roll * lever.y()) + square(m.pitch * lever.x());
  const double gauge = reference ? 0.0 : square(t.gauge_sigma);
  const double white = square(contact(s, rail));
  PointSigma out;
  const std::size_t n = s.rails.mileage.size();
  out.lateral.assign(n, nanf);
  out.vertical.assign(n, nanf);
  for (std::size_t i = 0; i < n; ++i) {
    const auto& p = (*s.input.trajectory)[s.rails.epoch[i]];
    const Eigen::Matrix3d C = p.q_nb.toRotationMatrix() * C_bv, P = p.position_covariance.matrix();
    const Eigen::Matrix3d A = p.attitude_covariance.matrix();
    const Eigen::Vector3d l = C * lever, right = Eigen::Vector3d(-C(1, 0), C(0, 0), 0.0).normalized();
    const Eigen::Vector3d up(0.0, 0.0, -1.0), a = right.cross(l), b = up.cross(l);
    const double fit = std::isfinite(line_of(s.rails, rail).fit_sigma[i]) ? line_of(s.rails, rail).fit_sigma[i] : 0.0;
    out.lateral[i] = static_cast<float>(
        std::sqrt(right.dot(P * right) + a.dot(A * a) + mount_lateral + gauge + white + square(fit)));
    out.vertical[i] = static_cast<float>(std::sqrt(P(2, 2) + b.dot(A * b) + mount_vertical + white));
  }
  return out;
}

void add_coordinates(Stage& s) {
  const std::size_t n = s.out.size();
  for (const Rail rail : {Rail::left, Rail::right}) {
    const RailLine& line = line_of(s.rails, rail);
    const PointSigma sigma = point_sigma(s, rail);
    const char* name = name_of(rail);
    Column e = s.out.add(fmt::format("easting_{}", name), "m", 1.0, fmt::format("Easting of the {} rail", name));
    Column u = s.out.add(fmt::format("northing_{}", name), "m", 1.0, fmt::format("Northing of the {} rail", name));
    Column h = s.out.add(fmt::format("height_{}", name), "m", 1.0,
                         fmt::format("Height of the {} rail's running surface at the head centre", name));
    for (std::size_t i = 0; i < n; ++i) {
      if (placed(s.rails, rail, i)) {
        e.value[i] = line.map[i].x();
        u.value[i] = line.map[i].y();
        e.sigma[i] = u.sigma[i] = sigma.lateral[i];
      }
      h.value[i] = line.height[i] + s.input.height_offset;
      h.sigma[i] = sigma.vertical[i];
    }
    *s.out.find(e.name) = std::move(e);
    *s.out.find(u.name) = std::move(u);
    *s.out.find(h.name) = std::move(h);
  }
  Column e = s.out.add("easting_axis", "m", 1.0, "Easting of the track axis, midway between the rails");
  Column u = s.out.add("northing_axis", "m", 1.0, "Northing of the track axis");
  Column h = s.out.add("height_axis", "m", 1.0, "Height of the track axis, mean of the rails");
  const std::string reference = s.rails.reference_is_left ? "left" : "right";
  const Column &es = s.out.at("easting_" + reference), &hs = s.out.at("height_" + reference);
  for (std::size_t i = 0; i < n; ++i) {
    // Where the gauge is missing the other rail was placed by the nominal gauge: good for the axis to some mm.
    const Eigen::Vector2d m = 0.5 * (s.rails.left.map[i] + s.rails.right.map[i]);
    const double missing = (s.rails.flags[i] & no_gauge) != 0 ? 2.5e-3 : 0.0;
    e.value[i] = m.x();
    u.value[i] = m.y();
    h.value[i] = 0.5 * (s.rails.left.height[i] + s.rails.right.height[i]) + s.input.height_offset;
    e.sigma[i] = u.sigma[i] = static_cast<float>(std::hypot(es.sigma[i], missing));
    h.sigma[i] = hs.sigma[i];
  }
  *s.out.find(e.name) = std::move(e);
  *s.out.find(u.name) = std::move(u);
  *s.out.find(h.name) = std::move(h);
}

void add_curvature_and_gradient(Stage& s) {
  const double base = s.options.curvature_base, step = s.options.step;
  const Rail rail = s.rails.reference_is_left ? Rail::left : Rail::right;
  const auto v = horizontal_versines(line_of(s.rails, rail).ecef, step, {base, 0.5 * base});
  Column& c = s.out.add("curvature", "1/km", 1e-3,
                        fmt::format("Curvature of the reference rail from the versine of a {} chord, positive in a "
                                    "right-hand curve",
                                    metres(base)));
  for (std::size_t i = 0; i < v.size(); ++i) c.value[i] = -8.0 * v[i] / (base * base);
  s.relative.fill(c, rail, Direction::lateral, {{-0.5 * base, -0.5}, {0.0, 1.0}, {0.5 * base, -0.5}}, contact(s, rail),
                  8.0 / (base * base));
  Column& g = s.out.add("gradient", "permille", 1e-3,
                        fmt::format("Gradient of the reference rail over {}, positive uphill", metres(base)));
  const auto& h = line_of(s.rails, rail).height;
  const double half = 0.5 * base / step;
  for (std::size_t i = 0; i < v.size(); ++i) {
    g.value[i] = (grid_value(h, double(i) + half) - grid_value(h, double(i) - half)) / base;
  }
  s.relative.fill(g, rail, Direction::vertical, {{-0.5 * base, -1.0}, {0.5 * base, 1.0}}, contact(s, rail), 1.0 / base);
}

namespace {

/// The reference rail seen from the chord between the trolley's two wheels on it.
struct WheelChord {
  std::vector<double> bow;   ///< rail right of the chord at the beam, m
  std::vector<double> bend;  ///< rail above the chord, m
};

/// Where the trajectory is smooth enough (most are), the bow is that of the measured rail, short waves included; else
/// the nominal one of Chen 2018 eq. 2.
WheelChord wheel_chord(const Stage& s) {
  const Trolley& t = s.input.trolley;
  const double a = t.front_x - t.other_x, b = t.other_x - t.rear_x;
  const RailLine& rail = s.rails.reference_is_left ? s.rails.left : s.rails.right;
  const Chord chord{a + b, s.run.direction > 0.0 ? b : a};
  WheelChord out{horizontal_versines(rail.ecef, s.options.step, chord),
                 scalar_versines(rail.height, s.options.step, chord)};
  const auto& measured = s.out.at("curvature").value;
  for (std::size_t i = 0; i < out.bow.size(); ++i) {
    if (std::isfinite(out.bow[i]) && std::isfinite(out.bend[i]) && rail.fit_sigma[i] <= 50e-6f) continue;
    const double k = !s.design.empty() && std::isfinite(s.design.curvature[i]) ? s.design.curvature[i] : measured[i];
    out.bow[i] = std::isfinite(k) ? -k * a * b / 2.0 : 0.0;
    out.bend[i] = 0.0;
  }
  return out;
}

void add_gauge(Stage& s, const WheelChord& wheels) {
  if (s.input.gauge.empty()) return;
  Column g =
      s.out.add("gauge", "mm", 1e-3, "Track gauge (Chen 2018 eqs. 1 and 2), corrected for temperature and curve");
  Column d = s.out.add("gauge_deviation", "mm", 1e-3, "Gauge minus nominal gauge");
  // The bow is a versine of the reference rail, each of whose points is a mean of two wheels.
  const float sigma =
      static_cast<float>(std::hypot(s.input.trolley.gauge_sigma, std::sqrt(1.75) * s.input.trolley.contact_sigma));
  for (std::size_t i = 0; i < s.out.size(); ++i) {
    // The sensor measures from the chord A1-A2: a rail that lies nearer to A3 than its chord has less gauge.
    g.value[i] = s.rails.sensed_gauge[i] - (s.rails.reference_is_left ? 1.0 : -1.0) * wheels.bow[i];
    d.value[i] = g.value[i] - s.options.nominal_gauge;
    if (std::isfinite(g.value[i])) g.sigma[i] = d.sigma[i] = sigma;
  }
  *s.out.find("gauge") = std::move(g);
  *s.out.find("gauge_deviation") = std::move(d);
}

}  // namespace

void add_gauge_cross_level_twist(Stage& s) {
  const Trolley& t = s.input.trolley;
  const std::size_t n = s.out.size();
  const WheelChord wheels = wheel_chord(s);
  add_gauge(s, wheels);
  // Two wheels on one side, one on the other; and the bend, a versine of points that are means of two wheels.
  const double noise = t.contact_sigma * std::sqrt(1.5 + 0.75);
  const Eigen::Matrix3d C_bv = geodesy::to_matrix(t.mounting).transpose();
  std::vector<float> sigma(n, nanf);
  std::vector<double> cross_level = s.rails.cross_level;
  for (std::size_t i = 0; i < n; ++i) {
    const auto& p = (*s.input.trajectory)[s.rails.epoch[i]];
    const Eigen::Vector3d f = p.q_nb * C_bv.col(0);
    const double roll = f.dot(p.attitude_covariance.matrix() * f) + square(t.mounting_sigma.roll);
    sigma[i] = static_cast<float>(std::sqrt(square(s.options.rail_distance) * roll + square(noise)));
    // The roll is that of the chord A1-A2 against A3; the rail itself is above or below that chord.
    cross_level[i] += (s.rails.reference_is_left ? 1.0 : -1.0) * wheels.bend[i];
  }
  Column& c = s.out.add("cross_level", "mm", 1e-3,
                        fmt::format("Cross level, {:.0f} mm times the sine of the roll; positive: left rail higher",
                                    1e3 * s.options.rail_distance));
  c.value = cross_level;
  c.sigma = sigma;
  if (s.design.has_cant()) {
    Column& d = s.out.add("cross_level_deviation", "mm", 1e-3, "Cross level minus design cant");
    for (std::size_t i = 0; i < n; ++i) d.value[i] = cross_level[i] - s.design.cant[i];
    d.sigma = sigma;
  }
  for (const double base : s.options.twist_bases) {
    Column& w = s.out.add("twist_" + metres(base), "mm/m", 1e-3,
                          fmt::format("Twist (D(s) - D(s - l)) / l over l = {}, cant ramps included", metres(base)));
    for (std::size_t i = 0; i < n; ++i) {
      w.value[i] = (cross_level[i] - grid_value(cross_level, double(i) - base / s.options.step)) / base;
    }
    s.relative.fill(w, Rail::left, Direction::roll, {{-base, -1.0}, {0.0, 1.0}}, noise, 1.0 / base);
  }
}

void add_deviations(Stage& s) {
  if (s.design.empty()) return;
  const std::size_t n = s.out.size();
  const double half =
      0.5 * (s.options.rail_point == RailPoint::head_centre ? s.options.rail_distance : s.options.nominal_gauge);
  for (const Rail rail : {Rail::left, Rail::right}) {
    const RailLine& line = line_of(s.rails, rail);
    const PointSigma sigma = point_sigma(s, rail);
    const double side = rail == Rail::left ? -1.0 : 1.0;
    Column& d = s.out.add(fmt::format("deviation_lateral_{}", name_of(rail)), "mm", 1e-3,
                          fmt::format("{} rail: lateral place minus design, positive to the right", name_of(rail)));
    for (std::size_t i = 0; i < n; ++i) {
      if ((s.rails.flags[i] & off_design) != 0 || !placed(s.rails, rail, i)) continue;
      const double c = std::cos(s.design.heading[i]), q = std::sin(s.design.heading[i]);
      const double offset =
          ((line.map[i].x() - s.design.easting[i]) * c - (line.map[i].y() - s.design.northing[i]) * q) /
          s.rails.map_scale[i];
      const double tilt = s.design.has_cant() ? s.design.cant[i] / s.options.rail_distance : 0.0;
      d.value[i] = offset - side * half * std::sqrt(1.0 - tilt * tilt);
      d.sigma[i] = sigma.lateral[i];
    }
    if (!s.design.has_heights()) continue;
    Column& v = s.out.add(fmt::format("deviation_vertical_{}", name_of(rail)), "mm", 1e-3,
                          fmt::format("{} rail: height minus design, positive upwards", name_of(rail)));
    for (std::size_t i = 0; i < n; ++i) {
      if ((s.rails.flags[i] & off_design) != 0) continue;
      const double cant = s.design.has_cant() ? s.design.cant[i] : 0.0;
      const double lift =
          s.options.height_reference == HeightReference::axis ? -side * 0.5 * cant : std::max(0.0, -side * cant);
      v.value[i] = line.height[i] + s.input.height_offset - s.design.height[i] - lift;
      v.sigma[i] = sigma.vertical[i];
    }
  }
  for (const char* what : {"lateral", "vertical"}) {
    const std::string stem = std::string("deviation_") + what;
    if (s.out.find(stem + "_left") == nullptr) continue;
    Column axis = s.out.add(stem + "_axis", "mm", 1e-3, fmt::format("Track axis: {} deviation from design", what));
    const Column &l = s.out.at(stem + "_left"), &r = s.out.at(stem + "_right");
    for (std::size_t i = 0; i < n; ++i) {
      const bool both = std::isfinite(l.value[i]) && std::isfinite(r.value[i]);
      axis.value[i] = both ? 0.5 * (l.value[i] + r.value[i]) : (std::isfinite(l.value[i]) ? l.value[i] : r.value[i]);
      axis.sigma[i] = std::isfinite(axis.value[i]) ? std::fmax(l.sigma[i], r.sigma[i]) : nanf;
    }
    *s.out.find(axis.name) = std::move(axis);
  }
}

void add_versines(Stage& s) {
  for (const Chord& chord : s.options.chords) {
    const bool middle = std::abs(chord.offset - 0.5 * chord.length) < 1e-9;
    const std::string label = metres(chord.length) + (middle ? "" : "_at_" + metres(chord.offset));
    const double part = chord.offset / chord.length;
    const std::vector<std::pair<double, double>> terms = {
        {-chord.offset, part - 1.0}, {0.0, 1.0}, {chord.length - chord.offset, -part}};
    for (const Rail rail : {Rail::left, Rail::right}) {
      const RailLine& line = line_of(s.rails, rail);
      Column& h = s.out.add(fmt::format("versine_lateral_{}_{}", name_of(rail), label), "mm", 1e-3,
                            fmt::format("Horizontal versine of the {} rail over {}, positive right of the chord",
                                        name_of(rail), metres(chord.length)));
      h.value = horizontal_versines(line.ecef, s.options.step, chord);
      for (std::size_t i = 0; i < h.value.size(); ++i) {
        if (!placed(s.rails, rail, i)) h.value[i] = nan;
      }
      s.relative.fill(h, rail, Direction::lateral, terms, contact(s, rail));
      Column& v = s.out.add(fmt::format("versine_vertical_{}_{}", name_of(rail), label), "mm", 1e-3,
                            fmt::format("Vertical versine of the {} rail over {}, in heights, positive above the chord",
                                        name_of(rail), metres(chord.length)));
      v.value = scalar_versines(line.height, s.options.step, chord);
      s.relative.fill(v, rail, Direction::vertical, terms, contact(s, rail));
    }
  }
}

void add_checks(Stage& s) {
  for (const char* what : {"lateral", "vertical"}) {
    for (const Rail rail : {Rail::left, Rail::right}) {
      const std::string source = fmt::format("deviation_{}_{}", what, name_of(rail));
      if (s.out.find(source) == nullptr) continue;
      const std::vector<double> e = s.out.at(source).value;
      const Direction direction = what[0] == 'l' ? Direction::lateral : Direction::vertical;
      for (const ChordCheck& c : s.options.checks) {
        const double f = c.distance / c.length;
        const std::vector<std::pair<double, double>> terms = {
            {-c.first, -f}, {0.0, 1.0}, {c.distance, -1.0}, {c.length - c.first, f}};
        const std::string stem = fmt::format("check_{}_{}_{}", c.name, what, name_of(rail));
        Column& own = s.out.add(stem, "mm", 1e-3,
                                fmt::format("Difference of versine deviations {} apart on a {} chord, {} rail, {}",
                                            metres(c.distance), metres(c.length), name_of(rail), what));
        own.value = chord_check(e, s.options.step, c);
        s.relative.fill(own, rail, direction, terms, contact(s, rail));
        const std::vector<float> sigma = own.sigma;
        Column& worst = s.out.add(stem + "_worst", "mm", 1e-3, "The same at the worst phase of the chord");
        worst.value = chord_check_worst(e, s.options.step, c);
        s.relative.fill(worst, rail, direction, terms, contact(s, rail));
      }
    }
  }
}

}  // namespace versine::track
