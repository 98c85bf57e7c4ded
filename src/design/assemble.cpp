// SPDX-License-Identifier: Apache-2.0
#include "versine/design/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace versine::design {

namespace {

using Verdict = AuditFinding::Verdict;

double apart(const MapPosition& a, const MapPosition& b) {
  return std::hypot(a.easting - b.easting, a.northing - b.northing);
}

/// Where the joints lie: the middle between the end of one element and the start of the next.
std::vector<MapPosition> joints(const RawAlignment& raw, const AuditLimits& limits, Audit& audit) {
  std::vector<MapPosition> joint;
  double distance = 0.0;
  for (std::size_t i = 0; i < raw.elements.size(); ++i) {
    const RawElement& e = raw.elements[i];
    MapPosition at = e.start;
    if (i > 0 && raw.elements[i - 1].end) {
      const MapPosition& before = *raw.elements[i - 1].end;
      const double gap = apart(before, e.start);
      if (!(gap <= limits.gap_noted)) {
        audit.push_back({gap <= limits.gap_refused ? Verdict::healed : Verdict::refused, "gap", e.where, distance, gap,
                         limits.gap_refused, "m", "between its start and the end of " + raw.elements[i - 1].where});
      }
      at = {0.5 * (before.easting + e.start.easting), 0.5 * (before.northing + e.start.northing)};
    }
    joint.push_back(at);
    distance += e.element.length;
  }
  if (raw.elements.back().end) joint.push_back(*raw.elements.back().end);
  return joint;
}

/// Turns and scales each element onto its joints. The last one, when its end is unknown, goes on from the one before.
std::vector<HorizontalAxis::Placed> fit(const RawAlignment& raw, const std::vector<MapPosition>& joint,
                                        const AuditLimits& limits, Audit& audit) {
  std::vector<HorizontalAxis::Placed> placed;
  double distance = 0.0;
  for (std::size_t i = 0; i < raw.elements.size(); ++i) {
    const RawElement& e = raw.elements[i];
    const AxisPose own = pose_on(e.element, {}, e.element.length);
    if (i + 1 < joint.size()) {
      const double easting = joint[i + 1].easting - joint[i].easting;
      const double northing = joint[i + 1].northing - joint[i].northing;
      const double given = std::hypot(easting, northing), nominal = std::hypot(own.easting, own.northing);
      const double turn = std::atan2(easting, northing) - std::atan2(own.easting, own.northing);
      placed.push_back({e.element, {joint[i].easting, joint[i].northing, turn}, distance, given / nominal});
      if (const double misfit = given - nominal; !(std::abs(misfit) <= limits.gap_noted)) {
        audit.push_back(
            {std::abs(misfit) <= limits.gap_refused ? Verdict::healed : Verdict::refused, "length", e.where, distance,
             misfit, limits.gap_refused, "m",
             fmt::format("its points are {:.4f} m apart, its length and radii say {:.4f} m", given, nominal)});
      }
    } else {
      const auto& last = placed.empty() ? HorizontalAxis::Placed{e.element, {}, 0.0, 1.0} : placed.back();
      const double heading = placed.empty() ? 0.0 : pose_on(last.element, last.start, last.element.length).heading;
      placed.push_back({e.element, {joint[i].easting, joint[i].northing, heading}, distance, 1.0});
    }
    distance += e.element.length;
  }
  return placed;
}

void audit_joints(const RawAlignment& raw, const std::vector<HorizontalAxis::Placed>& placed, const AuditLimits& limits,
                  Audit& audit) {
  for (std::size_t i = 1; i < placed.size(); ++i) {
    const HorizontalAxis::Placed &a = placed[i - 1], &b = placed[i];
    const AxisPose end = pose_on(a.element, a.start, a.element.length);
    const AxisPose start = pose_on(b.element, b.start, 0.0);
    const double kink = std::remainder(start.heading - end.heading, 2.0 * std::numbers::pi);
    const double swing = std::abs(kink) * std::min(a.element.length, b.element.length);
    const bool large = !(std::abs(kink) <= limits.kink_refused) && !(swing <= limits.gap_refused);
    if (!(std::abs(kink) <= limits.kink_noted)) {
      const bool intended = raw.elements[i].kink_intended;
      audit.push_back({large && !intended ? Verdict::refused : Verdict::noted, "kink", raw.elements[i].where,
                       b.distance, kink, limits.kink_refused, "rad",
                       intended ? "the file says so"
                                : fmt::format("against the end of {}; {:.2g} m at the far end of the shorter one",
                                              raw.elements[i - 1].where, swing)});
    }
    const double jump = start.curvature - end.curvature;
    if (std::abs(jump) > limits.curvature_jump_noted) {
      audit.push_back(
          {Verdict::noted, "curvature jump", raw.elements[i].where, b.distance, jump, 0.0, "1/m",
           fmt::format("from {} to {}",
                       end.curvature == 0.0 ? "straight" : fmt::format("R {:.3f} m", 1.0 / end.curvature),
                       start.curvature == 0.0 ? "straight" : fmt::format("R {:.3f} m", 1.0 / start.curvature))});
    }
  }
}

void audit_cant(const Alignment& a, const AuditLimits& limits, Audit& audit) {
  const auto& points = a.cant.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CantPoint& p = points[i];
    const std::string where = fmt::format("cant point {}", i + 1);
    if (!(std::abs(p.cant) <= limits.cant_refused)) {
      audit.push_back({Verdict::refused, "cant", where, p.distance, p.cant, limits.cant_refused, "m",
                       "no track has that much: is it in other units?"});
    }
    if (p.distance < -limits.ramp_noted || p.distance > a.length() + limits.ramp_noted) {
      audit.push_back({Verdict::noted, "cant outside the axis", where, p.distance, p.distance, 0.0, "m", ""});
      continue;
    }
    // Just inside both neighbouring elements the curvature of a joint is unambiguous.
    const double k1 = a.horizontal.at(p.distance - 0.5).curvature, k2 = a.horizontal.at(p.distance + 0.5).curvature;
    const double k = std::abs(k1) > std::abs(k2) ? k1 : k2;
    const bool against = std::abs(p.cant) > limits.cant_noted && k * p.cant < 0.0 && std::abs(k) > 1e-5;
    const bool on_straight = std::abs(p.cant) > limits.cant_noted && k1 == 0.0 && k2 == 0.0;
    if (against || on_straight) {
      audit.push_back({Verdict::noted, against ? "cant against curvature" : "cant on a straight", where, p.distance,
                       p.cant, limits.cant_noted, "m", fmt::format("curvature {:.3g} 1/m", k)});
    }
    if (i + 1 == points.size() || points[i + 1].cant == p.cant || points[i + 1].distance == p.distance) continue;
    // A ramp should begin and end with a transition.
    const auto& e = a.horizontal.elements()[a.horizontal.element_at(0.5 * (p.distance + points[i + 1].distance))];
    const double early = p.distance - e.distance;
    const double late = points[i + 1].distance - e.distance - e.element.length;
    if (!is_transition(e.element.shape)) {
      audit.push_back({Verdict::noted, "cant ramp without transition", where, p.distance, points[i + 1].cant - p.cant,
                       0.0, "m", fmt::format("on a {}", to_string(e.element.shape))});
    } else if (std::max(std::abs(early), std::abs(late)) > limits.ramp_noted) {
      audit.push_back({Verdict::noted, "cant ramp beside its transition", where, p.distance,
                       std::abs(early) > std::abs(late) ? early : late, limits.ramp_noted, "m",
                       fmt::format("begins {:+.3f} m, ends {:+.3f} m against it", early, late)});
    }
  }
}

void audit_extents(const Alignment& a, const AuditLimits& limits, Audit& audit) {
  if (a.profile.empty()) {
    audit.push_back({Verdict::noted, "no profile", "", 0.0, 0.0, 0.0, "", "heights are unknown"});
  } else {
    const double from = a.profile.points().front().distance, to = a.profile.points().back().distance;
    if (from > limits.ramp_noted || to < a.length() - limits.ramp_noted) {
      audit.push_back({Verdict::noted, "profile shorter than the axis", "", from, to - from, 0.0, "m",
                       fmt::format("from {:.3f} m to {:.3f} m of {:.3f} m", from, to, a.length())});
    }
  }
  if (a.cant.empty()) audit.push_back({Verdict::noted, "no cant", "", 0.0, 0.0, 0.0, "", "cant is unknown"});
  for (std::size_t i = 1; i < a.chainage.equations().size(); ++i) {
    const ChainageEquation& e = a.chainage.equations()[i];
    if (const double jump = a.chainage.jump(i); std::abs(jump) > 1e-3) {
      audit.push_back(
          {Verdict::noted, "chainage jump", e.name, e.distance, jump, 0.0, "m", "ahead " + format_mileage(e.mileage)});
    }
  }
}

/// Height of the centre of gravity over the rails that the Viennese bend is designed for when a file does not say, m.
constexpr double centre_of_gravity = 1.8;

/// The Viennese bend needs the change of cant along it.
void complete_viennese(RawAlignment& raw, const CantProfile& cant, Audit& audit) {
  double distance = 0.0;
  for (RawElement& e : raw.elements) {
    const double next = distance + e.element.length;
    if (e.element.shape == Shape::viennese && e.element.cant_term == 0.0 && !cant.empty()) {
      e.element.cant_term = centre_of_gravity * (cant.at(next).cant - cant.at(distance).cant) / cant_base;
      audit.push_back({Verdict::noted, "Viennese bend", e.where, distance, centre_of_gravity, 0.0, "m",
                       "height of the centre of gravity, assumed"});
    }
    distance = next;
  }
}

Expected<Alignment> build(RawAlignment raw, const AuditLimits& limits, Audit& audit) {
  Alignment a;
  a.name = raw.name;
  a.crs = raw.crs;
  if (raw.elements.empty()) {
    return fail({.field = "horizontal alignment", .found = "no element", .expected = "at least one element"});
  }
  if (!raw.profile.empty()) {
    auto profile = Profile::from_points(raw.profile);
    if (!profile) return tl::unexpected(profile.error());
    a.profile = *std::move(profile);
  }
  auto cant = CantProfile::from_points(raw.cant);
  if (!cant) return tl::unexpected(cant.error());
  auto chainage = Chainage::from_equations(raw.chainage);
  if (!chainage) return tl::unexpected(chainage.error());
  a.cant = *std::move(cant);
  a.chainage = *std::move(chainage);
  complete_viennese(raw, a.cant, audit);
  for (const RawElement& e : raw.elements) {
    // The evaluator needs sound numbers before joints can be looked at.
    if (auto sound = HorizontalAxis::place({{e.element, {}, 0.0, 1.0}}); !sound) {
      sound.error().field = e.where;
      return tl::unexpected(sound.error());
    }
  }
  const std::vector<MapPosition> joint = joints(raw, limits, audit);
  const std::vector<HorizontalAxis::Placed> placed = fit(raw, joint, limits, audit);
  audit_joints(raw, placed, limits, audit);
  auto axis = HorizontalAxis::place(placed);
  if (!axis) return tl::unexpected(axis.error());
  a.horizontal = *std::move(axis);
  audit_cant(a, limits, audit);
  audit_extents(a, limits, audit);
  return a;
}

}  // namespace

Imported assemble(const RawAlignment& raw, const AuditLimits& limits) {
  Imported out{raw.name, raw.findings, Alignment{}};
  out.alignment = build(raw, limits, out.audit);
  if (!out.alignment) {
    out.alignment.error().file = raw.file;
    return out;
  }
  const auto bad = std::count_if(out.audit.begin(), out.audit.end(),
                                 [](const AuditFinding& f) { return f.verdict == Verdict::refused; });
  if (bad > 0) {
    const AuditFinding& first = *std::find_if(out.audit.begin(), out.audit.end(),
                                              [](const AuditFinding& f) { return f.verdict == Verdict::refused; });
    out.alignment = fail({.file = raw.file,
                          .field = fmt::format("alignment '{}', {}", raw.name, first.element),
                          .found = fmt::format("{} of {:.4g} {} at {:.3f} m{}", first.kind, first.value, first.unit,
                                               first.distance, first.detail.empty() ? "" : " (" + first.detail + ")"),
                          .expected = fmt::format("at most {:.4g} {}", first.limit, first.unit),
                          .advice = fmt::format("mend the design{}; 'versine alignment' lists everything",
                                                bad > 1 ? fmt::format(" ({} findings are too large)", bad) : "")});
  }
  return out;
}

}  // namespace versine::design
