// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "parameters.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/track/butterworth.hpp"

namespace versine::track {
namespace {

/// Lateral course of a rail without design: its second differences, freed from everything longer than four times
/// `longest` (the design's curves), summed up twice. The band-pass behind it does the rest.
std::vector<double> unrolled(const RailLine& line, double step, double longest) {
  const std::size_t n = line.ecef.size();
  std::vector<double> bend(n, std::numeric_limits<double>::quiet_NaN());
  const double k = 1.0 / (1.0 - geodesy::wgs84.e2());
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Eigen::Vector3d &P = line.ecef[i], &A = line.ecef[i - 1], &B = line.ecef[i + 1];
    const Eigen::Vector3d up = Eigen::Vector3d(P.x(), P.y(), P.z() * k).normalized();
    bend[i] = -2.0 * (P - A).cross(B - A).dot(up) / (B - A).norm();  // second difference, positive to the right
  }
  const auto smooth =
      filter_both_ways(low_pass(4.0 * longest, step, 4), bend, static_cast<std::size_t>(8.0 * longest / step));
  std::vector<double> out(n, std::numeric_limits<double>::quiet_NaN());
  double slope = 0.0, y = 0.0;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (!std::isfinite(bend[i])) {
      slope = y = 0.0;
      continue;
    }
    out[i] = y;
    slope += bend[i] - smooth[i];
    y += slope;
  }
  return out;
}

std::size_t settle(const Band& band, double step) {
  return static_cast<std::size_t>(3.0 * band.longest / step);
}

Column& add_band(Stage& s, const Band& band, const std::vector<Biquad>& sections, Rail rail, bool lateral,
                 const std::vector<double>& signal, const char* source) {
  Column& c = s.out.add(
      fmt::format("{}_{}_{}", lateral ? "alignment" : "level", name_of(rail), band.name), "mm", 1e-3,
      fmt::format(
          "{} of the {} rail, {} to {}, from {}; Butterworth order {}, forward and backward, -3 dB at the edges",
          lateral ? "Alignment" : "Longitudinal level", name_of(rail), metres(band.shortest), metres(band.longest),
          source, s.options.filter_order));
  c.value = filter_both_ways(sections, signal, settle(band, s.options.step));
  return c;
}

/// What the band's filter makes of a single point, as far as it matters. Cut off there it would pass some thousandths
/// of a constant: of centimetres that all points share more than the band's own error. So their sum is taken off.
std::vector<double> response_of(const std::vector<Biquad>& sections, const Band& band, double step) {
  const auto reach = static_cast<std::size_t>(2.5 * band.longest / step);
  std::vector<double> impulse(8 * reach + 1, 0.0);
  impulse[4 * reach] = 1.0;
  impulse = filter_both_ways(sections, impulse, 0);
  const auto middle = impulse.begin() + static_cast<std::ptrdiff_t>(4 * reach);
  std::vector<double> out(middle - static_cast<std::ptrdiff_t>(reach), middle + static_cast<std::ptrdiff_t>(reach) + 1);
  const double sum = std::accumulate(out.begin(), out.end(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double hann = 0.5 + 0.5 * std::cos(std::numbers::pi * (double(i) - double(reach)) / double(reach));
    out[i] -= sum * hann / double(reach);
  }
  return out;
}

/// Points near the ends of each piece, where the longest band has not settled.
void flag_edges(Geometry& out, double longest) {
  const auto reach = static_cast<std::size_t>(longest / out.step);
  const auto missing = [&](std::size_t i) { return (out.flags[i] & no_trajectory) != 0; };
  std::size_t last = 0;  // first point of the current piece
  const std::size_t n = out.size();
  for (std::size_t i = 0; i <= n; ++i) {
    if (i < n && !missing(i)) continue;
    for (std::size_t k = last; k < i; ++k) {
      if (k - last < reach || i - k <= reach) out.flags[k] |= band_edge;
    }
    last = i + 1;
  }
}

}  // namespace

void add_bands(Stage& s) {
  std::vector<Band> bands;
  double longest = 0.0;
  for (const Band& band : s.options.bands) {
    if (band.shortest > 2.0 * s.options.step && band.longest > band.shortest) {
      bands.push_back(band);
      longest = std::max(longest, band.longest);
    } else {
      s.out.record.warnings.push_back(fmt::format("band {} ({} to {} m) needs a step below {} m: left out", band.name,
                                                  band.shortest, band.longest, 0.5 * band.shortest));
    }
  }
  if (bands.empty()) return;
  struct Signals {
    std::vector<double> lateral, vertical;
    const char *from_lateral, *from_vertical;
  };
  std::vector<Signals> rails;
  for (const Rail rail : {Rail::left, Rail::right}) {
    const Column* lateral = s.out.find(fmt::format("deviation_lateral_{}", name_of(rail)));
    const Column* vertical = s.out.find(fmt::format("deviation_vertical_{}", name_of(rail)));
    Signals x{lateral != nullptr ? lateral->value : unrolled(line_of(s.rails, rail), s.options.step, longest),
              vertical != nullptr ? vertical->value : line_of(s.rails, rail).height,
              lateral != nullptr ? "deviation from design" : "the rail's curvature",
              vertical != nullptr ? "deviation from design" : "heights"};
    for (std::size_t i = 0; i < x.lateral.size(); ++i) {
      if (!placed(s.rails, rail, i)) x.lateral[i] = std::numeric_limits<double>::quiet_NaN();
    }
    rails.push_back(std::move(x));
  }
  const double contact = s.input.trolley.contact_sigma, mean = contact * std::sqrt(0.5);
  const double left = s.rails.reference_is_left ? mean : contact, right = s.rails.reference_is_left ? contact : mean;
  for (const Band& band : bands) {
    const auto sections = band_pass(band.shortest, band.longest, s.options.step, s.options.filter_order);
    std::array<Column*, 4> columns{};
    for (std::size_t k = 0; k < 2; ++k) {
      const Rail rail = k == 0 ? Rail::left : Rail::right;
      columns[2 * k] = &add_band(s, band, sections, rail, true, rails[k].lateral, rails[k].from_lateral);
      columns[2 * k + 1] = &add_band(s, band, sections, rail, false, rails[k].vertical, rails[k].from_vertical);
    }
    s.relative.fill_filtered(columns, response_of(sections, band, s.options.step), {left, left, right, right});
  }
  flag_edges(s.out, longest);
}

}  // namespace versine::track
