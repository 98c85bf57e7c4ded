// SPDX-License-Identifier: Apache-2.0
#include "pointings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "versine/core/numbers.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/stationing/air.hpp"

namespace versine::stationing {
namespace {

constexpr double pi = std::numbers::pi;
using geodesy::wrap_pi;

Error at(const Stationing& s, const Sighting& r, std::string found, std::string expected, std::string advice) {
  return {.line = r.line,
          .field = fmt::format("station {}, point {}", s.name, r.point.empty() ? "without number" : r.point),
          .found = std::move(found),
          .expected = std::move(expected),
          .advice = std::move(advice)};
}

double corrected_distance(const Stationing& s, const Sighting& r, const Instrument& instrument) {
  const double air =
      s.atmosphere ? distance_factor(*s.atmosphere, instrument.reference_air, instrument.wavelength) : 1.0;
  return r.distance * air * (1.0 + 1e-6 * instrument.scale_ppm) + r.prism_constant;
}

}  // namespace

double median(std::vector<double> v) {
  if (v.empty()) return nan;
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

Expected<Grouped> group_readings(const Stationing& s) {
  Grouped g;
  std::vector<Sighting> seen;                        // first reading of each point
  std::map<std::pair<std::size_t, Face>, int> told;  // how often a point was seen in a face, for readings without set
  for (const Sighting& r : s.sightings) {
    if (!std::isfinite(r.direction) || !std::isfinite(r.zenith) || std::isinf(r.distance) || r.distance <= 0.0) {
      return fail(at(s, r, fmt::format("direction {}, zenith angle {}, distance {}", r.direction, r.zenith, r.distance),
                     "finite angles and a positive distance", "correct or remove this reading"));
    }
    if (!(r.zenith >= 0.0 && r.zenith <= 2.0 * pi)) {
      return fail(at(s, r, fmt::format("a zenith angle of {:.4f} gon", r.zenith / units::gon), "0 to 400 gon",
                     "is the column's unit right (gon, degrees, radians), and is it a zenith angle?"));
    }
    const double turn = r.face == Face::two ? pi : 0.0;
    const double zenith = r.face == Face::two ? 2.0 * pi - r.zenith : r.zenith;
    std::size_t i = 0;
    for (; i < seen.size(); ++i) {
      if (!r.point.empty() || !seen[i].point.empty()) {
        if (seen[i].point == r.point) break;
      } else if (std::abs(wrap_pi(seen[i].direction - r.direction + turn)) < 1e-3 &&
                 std::abs(seen[i].zenith - zenith) < 1e-3) {
        break;
      }
    }
    if (i == seen.size()) {
      seen.push_back(r);
      seen.back().direction = r.direction - turn;
      seen.back().zenith = zenith;
      g.points.push_back(r.point);
      g.line.push_back(r.line);
      g.target_height.push_back(r.target_height);
    } else if (std::abs(g.target_height[i] - r.target_height) > 1e-6) {
      return fail(at(s, r, fmt::format("a target height of {:.4f} m", r.target_height),
                     fmt::format("{:.4f} m as in line {}", g.target_height[i], g.line[i]),
                     "one station sees a point at one height; give the second prism its own number"));
    }
    const int set = r.set > 0 ? r.set : ++told[{i, r.face}];
    Pointing& p = g.sets[set][i];
    auto& slot = r.face == Face::one ? p.one : p.two;
    if (slot) {
      return fail(at(s, r, fmt::format("a second reading in face {} of set {}", r.face == Face::one ? 1 : 2, set),
                     "one reading per point, face and set", "number the sets, or remove the repeated reading"));
    }
    slot = r;
  }
  return g;
}

Expected<void> check_unit(const Stationing& s, const Grouped& g) {
  std::vector<double> sums;
  for (const auto& [number, set] : g.sets) {
    for (const auto& [i, p] : set) {
      if (p.both()) sums.push_back((p.one->zenith + p.two->zenith) / (2.0 * pi));
    }
  }
  if (sums.empty()) return {};
  const double sum = median(sums);
  if (std::abs(sum - 1.0) < 0.02) return {};
  Error error{.field = fmt::format("station {}, zenith angles", s.name),
              .found = fmt::format("both faces sum to {:.2f} gon ({:.2f} deg)", sum * 400.0, sum * 360.0),
              .expected = "a full circle",
              .advice = "zenith angles of face I and face II must belong to the same target and unit"};
  if (std::abs(sum - 0.9) < 0.01) error.advice = "the values look like degrees in a column of gon: name it zenith_deg";
  if (std::abs(sum - 1.0 / 0.9) < 0.01) {
    error.advice = "the values look like gon in a column of degrees: name it zenith_gon";
  }
  return fail(std::move(error));
}

AxisErrors axis_errors(const Grouped& g) {
  AxisErrors e;
  for (const auto& [number, set] : g.sets) {
    for (const auto& [i, p] : set) {
      if (!p.both()) continue;
      e.collimation.push_back(0.5 * wrap_pi(p.two->direction - p.one->direction - pi) * std::sin(p.one->zenith));
      e.index.push_back(0.5 * (p.one->zenith + p.two->zenith - 2.0 * pi));
    }
  }
  return e;
}

// Face I reads r - c / sin z and z + i, face II the opposite.
void merge_faces(const Stationing& s, const Instrument& instrument, double collimation, double index, Grouped& g) {
  for (auto& [number, set] : g.sets) {
    for (auto& [i, p] : set) {
      const Sighting& any = p.one ? *p.one : *p.two;
      std::vector<double> distances;
      for (const auto& r : {p.one, p.two}) {
        if (r && !std::isnan(r->distance)) distances.push_back(corrected_distance(s, *r, instrument));
      }
      p.distance = distances.empty() ? nan : 0.0;
      for (const double d : distances) p.distance += d / static_cast<double>(distances.size());
      if (p.both()) {
        p.direction = p.one->direction + 0.5 * wrap_pi(p.two->direction - p.one->direction - pi);
        p.zenith = 0.5 * (p.one->zenith + 2.0 * pi - p.two->zenith);
      } else if (p.one) {
        p.direction = any.direction + collimation / std::sin(any.zenith);
        p.zenith = any.zenith - index;
      } else {
        p.direction = any.direction - pi - collimation / std::sin(2.0 * pi - any.zenith);
        p.zenith = 2.0 * pi - any.zenith + index;
      }
    }
  }
}

}  // namespace versine::stationing
