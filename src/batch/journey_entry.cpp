// SPDX-License-Identifier: Apache-2.0
#include "versine/batch/journey_entry.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace versine::batch {

using Json = nlohmann::ordered_json;

namespace {
constexpr const char* journeys_format = "versine journeys 1";

struct Cubic {
  const Knot &a, &b;
  double span = (b.time - a.time).seconds();

  [[nodiscard]] double distance(double u) const {
    const double v = 1.0 - u;
    return v * v * (1.0 + 2.0 * u) * a.distance + u * u * (3.0 - 2.0 * u) * b.distance +
           u * v * span * (v * a.speed - u * b.speed);
  }
  [[nodiscard]] double speed(double u) const {
    const double slope = span > 0.0 ? (b.distance - a.distance) / span : 0.0;
    return 6.0 * u * (1.0 - u) * slope + (1.0 - u) * (1.0 - 3.0 * u) * a.speed + u * (3.0 * u - 2.0) * b.speed;
  }
};

// Millimetres and millimetres a second as integers: short, and the same text everywhere.
std::int64_t thousandths(double x) {
  return std::llround(x * 1000.0);
}

Json knots_json(const std::vector<Knot>& knots) {
  Json list = Json::array();
  for (const Knot& k : knots) {
    list.push_back({k.time.ns, thousandths(k.distance), thousandths(k.speed), thousandths(k.sigma)});
  }
  return list;
}

Json journey_json(const JourneyEntry& j) {
  Json paths = Json::array(), passes = Json::array();
  for (const auto& p : j.paths) paths.push_back({{"probability", p.probability}, {"tracks", p.tracks}});
  for (const auto& p : j.passes) {
    passes.push_back({{"track", p.track}, {"probability", p.probability}, {"knots", knots_json(p.knots)}});
  }
  return {{"recording", j.recording},   {"number", j.number},     {"scale", static_cast<int>(j.scale)},
          {"from_ns", j.from.ns},       {"to_ns", j.to.ns},       {"length_m", j.length},
          {"entropy_nat", j.entropy},   {"paths", paths},         {"fixes", j.fixes},
          {"rejected", j.rejected},     {"mean_nis", j.mean_nis}, {"sigma_rms_m", j.sigma_rms},
          {"sigma_max_m", j.sigma_max}, {"passes", passes}};
}

JourneyEntry journey_from(const Json& j) {
  JourneyEntry e;
  e.recording = j.at("recording"), e.number = j.at("number");
  e.scale = static_cast<TimeScale>(j.at("scale").get<int>());
  e.from.ns = j.at("from_ns"), e.to.ns = j.at("to_ns");
  e.length = j.at("length_m"), e.entropy = j.at("entropy_nat");
  for (const auto& p : j.at("paths")) e.paths.push_back({p.at("probability"), p.at("tracks")});
  e.fixes = j.at("fixes"), e.rejected = j.at("rejected"), e.mean_nis = j.at("mean_nis");
  e.sigma_rms = j.at("sigma_rms_m"), e.sigma_max = j.at("sigma_max_m");
  for (const auto& p : j.at("passes")) {
    Pass pass{p.at("track"), p.at("probability"), {}};
    for (const auto& k : p.at("knots")) {
      pass.knots.push_back({{k.at(0).get<std::int64_t>()},
                            1e-3 * k.at(1).get<double>(),
                            1e-3 * k.at(2).get<double>(),
                            1e-3 * k.at(3).get<double>()});
    }
    e.passes.push_back(std::move(pass));
  }
  return e;
}
}  // namespace

std::optional<Knot> knot_at(const Pass& pass, double distance) {
  for (std::size_t i = 0; i + 1 < pass.knots.size(); ++i) {
    const Knot &a = pass.knots[i], &b = pass.knots[i + 1];
    if ((a.distance - distance) * (b.distance - distance) > 0.0) continue;
    const Cubic cubic{a, b};
    const bool up = a.distance <= b.distance;
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 40; ++k) {
      const double mid = 0.5 * (low + high);
      ((cubic.distance(mid) < distance) == up ? low : high) = mid;
    }
    return Knot{a.time + Duration::from_seconds(low * cubic.span), distance, cubic.speed(low),
                a.sigma + low * (b.sigma - a.sigma)};
  }
  return std::nullopt;
}

std::string to_text(const Summary& s) {
  Json journeys = Json::array(), failures = Json::array();
  for (const auto& j : s.journeys) journeys.push_back(journey_json(j));
  for (const auto& f : s.failures) {
    const Error& e = f.error;
    failures.push_back({{"recording", f.recording},
                        {"line", e.line},
                        {"field", e.field},
                        {"found", e.found},
                        {"expected", e.expected},
                        {"advice", e.advice}});
  }
  return Json{{"format", journeys_format}, {"journeys", journeys}, {"failures", failures}}.dump(
             -1, ' ', false, Json::error_handler_t::replace) +
         "\n";
}

Expected<Summary> summary_from(const std::string& text) {
  try {
    const Json j = Json::parse(text);
    Summary s;
    for (const auto& e : j.at("journeys")) s.journeys.push_back(journey_from(e));
    for (const auto& f : j.at("failures")) {
      s.failures.push_back(
          {f.at("recording"), {{}, f.at("line"), f.at("field"), f.at("found"), f.at("expected"), f.at("advice")}});
    }
    return s;
  } catch (const nlohmann::json::exception& e) {
    return fail({.field = "summary", .found = e.what(), .expected = "an object written by this version"});
  }
}

}  // namespace versine::batch
