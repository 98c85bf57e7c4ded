// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/reduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "versine/geodesy/attitude.hpp"
#include "versine/stationing/air.hpp"

namespace versine::stationing {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double earth_radius = 6.371e6;
using geodesy::wrap_pi;

/// One target in one set.
struct Pointing {
  std::optional<Sighting> one, two;
  double direction = nan, zenith = nan, distance = nan;  // as face I
  bool both() const { return one && two; }
};
using Set = std::map<std::size_t, Pointing>;  // by index of the point

struct Grouped {
  std::vector<std::string> points;
  std::vector<std::size_t> line;
  std::vector<double> target_height;
  std::map<int, Set> sets;
};

double median(std::vector<double> v) {
  if (v.empty()) return nan;
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

Error at(const Stationing& s, const Sighting& r, std::string found, std::string expected, std::string advice) {
  return {.line = r.line,
          .field = fmt::format("station {}, point {}", s.name, r.point.empty() ? "without number" : r.point),
          .found = std::move(found),
          .expected = std::move(expected),
          .advice = std::move(advice)};
}

/// Sorts readings by set and point. Unnamed targets are told apart by where they point.
Expected<Grouped> group(const Stationing& s) {
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

double corrected_distance(const Stationing& s, const Sighting& r, const Instrument& instrument) {
  const double air =
      s.atmosphere ? distance_factor(*s.atmosphere, instrument.reference_air, instrument.wavelength) : 1.0;
  return r.distance * air * (1.0 + 1e-6 * instrument.scale_ppm) + r.prism_constant;
}

/// Two faces sum to a full circle; in a wrong unit they sum to 0.9 or 1.11 of it.
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

struct AxisErrors {
  std::vector<double> collimation, index;
};

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

/// Each pointing as it would be in face I without axis errors. Face I reads r - c / sin z and z + i, face II the
/// opposite.
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

/// Brings every set to the first one, whatever the circle was turned by in between.
void turn_sets(Grouped& g) {
  std::vector<double> first(g.points.size(), nan);
  for (auto& [number, set] : g.sets) {
    std::vector<double> differences;
    double reference = nan;
    for (const auto& [i, p] : set) {
      if (std::isnan(first[i])) continue;
      if (std::isnan(reference)) reference = p.direction - first[i];
      differences.push_back(wrap_pi(p.direction - first[i] - reference));
    }
    const double turn = differences.empty() ? 0.0 : reference + median(differences);
    for (auto& [i, p] : set) {
      p.direction -= turn;
      if (std::isnan(first[i])) first[i] = p.direction;
      p.direction = first[i] + wrap_pi(p.direction - first[i]);
    }
  }
}

/// Least squares in two ways (points, sets), by alternation: sets may hold different points.
void adjust_sets(Grouped& g) {
  if (g.sets.size() < 2) return;
  std::vector<double> mean(g.points.size());
  for (int round = 0; round < 10; ++round) {
    std::vector<double> sum(mean.size(), 0.0), count(mean.size(), 0.0);
    for (const auto& [number, set] : g.sets) {
      for (const auto& [i, p] : set) sum[i] += p.direction, count[i] += 1.0;
    }
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = sum[i] / std::max(1.0, count[i]);
    double largest = 0.0;
    for (auto& [number, set] : g.sets) {
      double shift = 0.0;
      for (const auto& [i, p] : set) shift += (p.direction - mean[i]) / static_cast<double>(set.size());
      for (auto& [i, p] : set) p.direction -= shift;
      largest = std::max(largest, std::abs(shift));
    }
    if (largest < 1e-12) break;
  }
}

struct Mean {
  double value = nan, spread = nan;
};
Mean mean_of(const std::vector<double>& v) {
  if (v.empty()) return {};
  double sum = 0.0, squares = 0.0;
  for (const double x : v) sum += x - v.front();
  const double mean = v.front() + sum / static_cast<double>(v.size());
  for (const double x : v) squares += (x - mean) * (x - mean);
  return {mean, v.size() < 2 ? nan : std::sqrt(squares / static_cast<double>(v.size() - 1))};
}

/// Removes pointings of a point that lie far from the median of its sets; returns how many readings.
std::size_t drop_outliers(Grouped& g, std::size_t i, const Instrument& instrument) {
  std::vector<double> r, z, d;
  for (const auto& [number, set] : g.sets) {
    const auto p = set.find(i);
    if (p == set.end()) continue;
    r.push_back(p->second.direction);
    z.push_back(p->second.zenith);
    if (!std::isnan(p->second.distance)) d.push_back(p->second.distance);
  }
  if (r.size() < 3) return 0;
  const double r0 = median(r), z0 = median(z), d0 = median(d);
  const double angle =
      6.0 * std::sqrt(2.0) * std::hypot(instrument.angle_sigma, instrument.target_sigma / std::max(d0, 1.0));
  const double range = 6.0 * (instrument.distance_sigma + 1e-6 * instrument.distance_sigma_ppm * d0);
  std::size_t dropped = 0;
  for (auto& [number, set] : g.sets) {
    const auto it = set.find(i);
    if (it == set.end()) continue;
    const Pointing& p = it->second;
    if (std::abs(p.direction - r0) * std::sin(z0) > angle || std::abs(p.zenith - z0) > angle ||
        std::abs(p.distance - d0) > range) {
      dropped += p.both() ? 2 : 1;
      set.erase(it);
    }
  }
  return dropped;
}

Target target_of(const std::vector<const Pointing*>& pointings, const Instrument& instrument) {
  std::vector<double> r, z, d;
  double weight = 0.0;  // in pairs of faces
  Target t;
  for (const Pointing* p : pointings) {
    r.push_back(p->direction);
    z.push_back(p->zenith);
    if (!std::isnan(p->distance)) d.push_back(p->distance);
    weight += p->both() ? 1.0 : 0.5;
    t.readings += p->both() ? 2 : 1;
  }
  const Mean direction = mean_of(r), zenith = mean_of(z), distance = mean_of(d);
  t.direction = wrap_pi(direction.value);
  t.distance = distance.value;
  // Light bends towards the Earth: the target seems higher by k d / 2R.
  const double bent = std::isnan(t.distance) ? 0.0 : instrument.refraction * t.distance / (2.0 * earth_radius);
  t.zenith = zenith.value + bent * std::sin(zenith.value);
  t.direction_sigma = t.zenith_sigma = instrument.angle_sigma / std::sqrt(weight);
  t.distance_sigma = std::hypot(instrument.distance_sigma, 1e-6 * instrument.distance_sigma_ppm * t.distance);
  t.direction_spread = direction.spread;
  t.zenith_spread = zenith.spread;
  t.distance_spread = distance.spread;
  return t;
}

void warn_about_faces(const Grouped& g, const AxisErrors& axis, const Instrument& instrument, ReducedStation& out) {
  std::size_t single = 0, pairs = 0;
  for (const auto& [number, set] : g.sets) {
    for (const auto& [i, p] : set) p.both() ? ++pairs : ++single;
  }
  if (single > 0 && pairs == 0 && instrument.collimation == 0.0 && instrument.index_error == 0.0) {
    out.warnings.push_back(
        "no target was read in both faces: collimation and index error stay in the readings; measure face II, or give "
        "collimation_arcsec and index_error_arcsec of a calibration");
  } else if (single > 0 && pairs > 0) {
    out.warnings.push_back(
        fmt::format("{} of {} pointings have one face only; corrected with the axis errors of the "
                    "other pointings",
                    single, single + pairs));
  }
  const Mean c = mean_of(axis.collimation);
  if (axis.collimation.size() > 3 && c.spread > 5.0 * instrument.angle_sigma + instrument.target_sigma / 5.0) {
    out.warnings.push_back(fmt::format(
        "collimation scatters by {:.1f}\" among pointings: was the instrument disturbed?", c.spread / units::arcsec));
  }
}

}  // namespace

Expected<ReducedStation> reduce(const Stationing& s, const Instrument& instrument) {
  if (s.sightings.empty()) {
    return fail({.field = fmt::format("station {}", s.name),
                 .found = "no readings",
                 .expected = "at least three targets",
                 .advice = "remove the station, or add its readings"});
  }
  auto g = group(s);
  if (!g) return tl::unexpected(g.error());
  if (auto unit = check_unit(s, *g); !unit) return tl::unexpected(unit.error());

  ReducedStation out{
      .name = s.name, .mark = s.mark, .instrument_height = s.instrument_height, .from = s.from, .to = s.to};
  const AxisErrors axis = axis_errors(*g);
  if (!axis.collimation.empty()) {
    out.collimation = median(axis.collimation);
    out.index_error = median(axis.index);
  }
  warn_about_faces(*g, axis, instrument, out);
  merge_faces(s, instrument, out.collimation.value_or(instrument.collimation),
              out.index_error.value_or(instrument.index_error), *g);
  turn_sets(*g);
  out.sets = g->sets.size();
  for (std::size_t i = 0; i < g->points.size(); ++i) {
    const std::size_t dropped = drop_outliers(*g, i, instrument);
    if (dropped == 0) continue;
    out.dropped += dropped;
    out.warnings.push_back(
        fmt::format("point {}: {} readings contradict the other sets and were left out", g->points[i], dropped));
  }
  std::erase_if(g->sets, [](const auto& set) { return set.second.empty(); });
  adjust_sets(*g);
  for (std::size_t i = 0; i < g->points.size(); ++i) {
    std::vector<const Pointing*> pointings;
    for (const auto& [number, set] : g->sets) {
      if (const auto it = set.find(i); it != set.end()) pointings.push_back(&it->second);
    }
    if (pointings.empty()) continue;
    Target t = target_of(pointings, instrument);
    t.point = g->points[i];
    t.target_height = g->target_height[i];
    t.line = g->line[i];
    out.targets.push_back(std::move(t));
  }
  return out;
}

}  // namespace versine::stationing
