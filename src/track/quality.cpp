// SPDX-License-Identifier: Apache-2.0
#include "versine/track/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "versine/core/numbers.hpp"
#include "versine/track/butterworth.hpp"
#include "versine/track/versine.hpp"

namespace versine::track {
namespace {

int severity_of(const LimitProfile& profile, const std::string& level) {
  const auto it = std::find(profile.levels.begin(), profile.levels.end(), level);
  return static_cast<int>(it - profile.levels.begin());
}

/// Limits of one column, mildest first.
struct ColumnLimits {
  std::vector<std::pair<int, const Limit*>> by_severity;
};

/// How far a value is over a limit; negative when it is inside.
double over(const Limit& limit, double value, double sign) {
  return sign > 0 ? value - limit.high : limit.low - value;
}

void close(const Geometry& g, const Column& c, const ColumnLimits& limits, double sign, std::size_t a, std::size_t b,
           std::vector<Exceedance>& out) {
  Exceedance e;
  e.column = c.name;
  e.index = a;
  for (std::size_t i = a; i <= b; ++i) {
    if (sign * c.value[i] > sign * c.value[e.index]) e.index = i;
  }
  e.start = g.mileage[a];
  e.end = g.mileage[b];
  e.peak = g.mileage[e.index];
  e.value = c.value[e.index];
  e.sigma = c.sigma.empty() ? nan : c.sigma[e.index];
  for (const auto& [severity, limit] : limits.by_severity) {
    if (over(*limit, e.value, sign) > 0.0) {
      e.severity = severity;
      e.level = limit->level;
      e.limit = sign > 0 ? limit->high : limit->low;
    }
  }
  // Phi((|v| - limit) / sigma)
  const double z = sign * (e.value - e.limit) / e.sigma;
  e.probability = e.sigma > 0.0 ? 0.5 * std::erfc(-z / std::sqrt(2.0)) : nan;
  out.push_back(std::move(e));
}

void scan(const Geometry& g, const Column& c, const ColumnLimits& limits, double merge, std::vector<Exceedance>& out) {
  const Limit& mildest = *limits.by_severity.front().second;
  const auto gap = static_cast<std::size_t>(g.step > 0.0 ? merge / g.step : 1.0);
  for (const double sign : {1.0, -1.0}) {
    std::size_t first = 0, last = 0;
    bool open = false;
    for (std::size_t i = 0; i < c.value.size(); ++i) {
      if (!(over(mildest, c.value[i], sign) > 0.0)) continue;  // NaN is not over
      if (open && i - last > gap) {
        close(g, c, limits, sign, first, last, out);
        open = false;
      }
      if (!open) first = i;
      open = true;
      last = i;
    }
    if (open) close(g, c, limits, sign, first, last, out);
  }
}

double deviation(const std::vector<double>& x, std::size_t a, std::size_t b) {
  double n = 0, mean = 0, m2 = 0;
  for (std::size_t i = a; i < b; ++i) {
    if (!std::isfinite(x[i])) continue;
    n += 1;
    const double d = x[i] - mean;
    mean += d / n;
    m2 += d * (x[i] - mean);
  }
  return n < 0.5 * double(b - a) || n < 2 ? nan : std::sqrt(m2 / (n - 1));
}

using Series = std::map<std::string, std::vector<double>>;

/// Cross level and twist as statistics take them: without cant and its ramps, which are no irregularity. Less the
/// design's cant; where there is none, freed of wavelengths beyond 70 m.
Series without_cant(const Geometry& g) {
  constexpr double longest = 70.0;
  const Column *cross_level = g.find("cross_level"), *deviation = g.find("cross_level_deviation");
  if (cross_level == nullptr || !(g.step > 0.0)) return {};
  Series out;
  std::vector<double>& x = out["cross_level"];
  x = deviation != nullptr ? deviation->value : cross_level->value;
  if (deviation == nullptr) {
    const auto cant =
        filter_both_ways(low_pass(longest, g.step, 4), x, static_cast<std::size_t>(3.0 * longest / g.step));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] -= cant[i];
  }
  for (const Column& c : g.columns) {
    if (!c.name.starts_with("twist_")) continue;
    const double base = std::strtod(c.name.c_str() + 6, nullptr);
    if (!(base > 0.0)) continue;
    std::vector<double>& twist = out[c.name];
    for (std::size_t i = 0; i < x.size(); ++i)
      twist.push_back((x[i] - grid_value(x, double(i) - base / g.step)) / base);
  }
  return out;
}

double sigma_of(const Section& s, const std::string& column) {
  for (const auto& [name, sigma] : s.sigma) {
    if (name == column) return sigma;
  }
  return nan;
}

/// CoSD of EN 13848-6: alignment and level as the mean of both rails' sigmas.
double combined(const Section& s, const std::vector<double>& w) {
  if (w.size() != 4) return nan;
  const auto mean = [&](const char* what) {
    return 0.5 * (sigma_of(s, std::string(what) + "_left_d1") + sigma_of(s, std::string(what) + "_right_d1"));
  };
  const double al = mean("alignment"), ll = mean("level");
  const double g = sigma_of(s, "gauge"), cl = sigma_of(s, "cross_level");
  return std::sqrt(w[0] * al * al + w[1] * g * g + w[2] * cl * cl + w[3] * ll * ll);
}

Section section_of(const Geometry& g, const Series& no_cant, const LimitProfile& profile, const SpeedClass& speed,
                   std::size_t a, std::size_t b) {
  Section s{.start = g.mileage[a], .end = g.mileage[b - 1]};
  for (const Column& c : g.columns) {
    const bool wanted = c.name.starts_with("alignment_") || c.name.starts_with("level_") || c.name == "gauge" ||
                        c.name.starts_with("cross_level") || c.name.starts_with("twist_");
    const auto free = no_cant.find(c.name);
    if (wanted) s.sigma.emplace_back(c.name, deviation(free != no_cant.end() ? free->second : c.value, a, b));
  }
  s.tqi = profile.tqi_columns.empty() ? nan : 0.0;
  for (const std::string& name : profile.tqi_columns) {
    // Twist is a ratio; its share is the sigma of the difference over its base, given as "twist_3m*3".
    const auto star = name.find('*');
    const double factor = star == std::string::npos ? 1.0 : std::stod(name.substr(star + 1));
    s.tqi += factor * sigma_of(s, name.substr(0, star));
  }
  s.cosd = combined(s, profile.cosd_weights);
  for (const SectionLimit& limit : speed.section_limits) {
    for (const auto& [name, sigma] : s.sigma) {
      if (matches(limit.column, name) && sigma > limit.sigma) s.over.push_back(limit.level + " of " + name);
    }
  }
  if (speed.tqi > 0.0 && s.tqi > speed.tqi) s.over.push_back("TQI");
  for (const QualityClasses& q : speed.classes) {
    for (const auto& [name, sigma] : s.sigma) {
      if (!matches(q.column, name) || !std::isfinite(sigma)) continue;
      const auto k = std::lower_bound(q.bounds.begin(), q.bounds.end(), sigma) - q.bounds.begin();
      if (static_cast<std::size_t>(k) < q.names.size())
        s.classes.emplace_back(name, q.names[static_cast<std::size_t>(k)]);
    }
  }
  return s;
}

}  // namespace

bool matches(const std::string& pattern, const std::string& name) {
  const auto star = pattern.find('*');
  if (star == std::string::npos) return pattern == name;
  const std::string head = pattern.substr(0, star), tail = pattern.substr(star + 1);
  return name.size() >= head.size() + tail.size() && name.starts_with(head) && name.ends_with(tail);
}

Expected<Quality> assess(const Geometry& g, const LimitProfile& profile, double speed, double merge) {
  const auto it = std::find_if(profile.speeds.begin(), profile.speeds.end(),
                               [&](const SpeedClass& c) { return speed <= c.speed * (1.0 + 1e-9); });
  if (it == profile.speeds.end()) {
    return fail({.field = "quality.speed_kmh",
                 .found = fmt::format("{:.0f} km/h", speed * 3.6),
                 .expected = profile.speeds.empty() ? "a profile with speed classes"
                                                    : fmt::format("at most {:.0f} km/h, the highest class of '{}'",
                                                                  profile.speeds.back().speed * 3.6, profile.name),
                 .advice = "choose another profile or add a class to it"});
  }
  Quality out{.profile = profile.name, .source = profile.source, .speed = speed, .levels = profile.levels};
  out.tqi_limit = it->tqi;
  std::map<std::string, ColumnLimits> by_column;
  for (const Limit& limit : it->limits) {
    bool found = false;
    for (const Column& c : g.columns) {
      if (!matches(limit.column, c.name)) continue;
      found = true;
      by_column[c.name].by_severity.emplace_back(severity_of(profile, limit.level), &limit);
    }
    if (!found && std::find(out.unchecked.begin(), out.unchecked.end(), limit.column) == out.unchecked.end()) {
      out.unchecked.push_back(limit.column);
    }
  }
  for (auto& [name, limits] : by_column) {
    std::sort(limits.by_severity.begin(), limits.by_severity.end());
    for (const auto& [severity, limit] : limits.by_severity) {
      out.applied.push_back(*limit);
      out.applied.back().column = name;
    }
    scan(g, g.at(name), limits, merge, out.exceedances);
  }
  std::sort(out.exceedances.begin(), out.exceedances.end(),
            [](const Exceedance& a, const Exceedance& b) { return a.peak < b.peak; });
  const Series no_cant = without_cant(g);
  for (std::size_t a = 0; a < g.size();) {
    // Sections begin at multiples of their length, so that those of several runs are the same.
    const double end = (std::floor(g.mileage[a] / profile.section + 1e-9) + 1.0) * profile.section;
    std::size_t b = a;
    while (b < g.size() && g.mileage[b] < end - 1e-9) ++b;
    if (g.mileage[b - 1] - g.mileage[a] > 0.5 * profile.section)
      out.sections.push_back(section_of(g, no_cant, profile, *it, a, b));
    a = b;
  }
  return out;
}

}  // namespace versine::track
