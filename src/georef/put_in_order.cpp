// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "versine/georef/journeys.hpp"

namespace versine::georef {

namespace {

struct Removed {
  const char* kind;
  std::size_t count = 0, first = 0;
  Time from, to;
  void add(std::size_t index, Time t) {
    if (count++ == 0) from = t, first = index;
    to = t;
  }
  void report(const char* sensor, RunRecord& record) const {
    if (count == 0) return;
    record.findings.push_back(
        {sensor, kind, from, to, count, Finding::Action::removed, fmt::format("first at record {}", first + 1)});
  }
};

/// Keeps what moves time forward. A step backwards removes all that follows until time has caught up.
template <class Sample, class Good>
void keep_forward(Series<Sample>& series, const char* sensor, RunRecord& record, Good good) {
  Removed standing{"standing clock"}, backward{"time running backwards"}, nan{"not a number"};
  std::vector<Sample> kept;
  kept.reserve(series.size());
  for (std::size_t i = 0; i < series.size(); ++i) {
    const Sample& s = series[i];
    if (!good(s)) {
      nan.add(i, s.time);
    } else if (!kept.empty() && s.time == kept.back().time) {
      standing.add(i, s.time);
    } else if (!kept.empty() && s.time < kept.back().time) {
      backward.add(i, s.time);
    } else {
      kept.push_back(s);
    }
  }
  standing.report(sensor, record), backward.report(sensor, record), nan.report(sensor, record);
  series.samples = std::move(kept);
}

/// Samples that a busy computer stamped late, all at once after a gap: their number fills the gap, so they are spread.
void spread_batches(Series<InertialSample>& imu, RunRecord& record) {
  if (imu.size() < 10) return;
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < imu.size(); ++i) steps.push_back((imu[i].time - imu[i - 1].time).ns);
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  const auto nominal = static_cast<double>(steps[steps.size() / 2]);
  std::size_t count = 0;
  Time first, last;
  for (std::size_t i = 1; i < imu.size(); ++i) {
    if (static_cast<double>((imu[i].time - imu[i - 1].time).ns) < 2.5 * nominal) continue;
    std::size_t j = i;
    while (j + 1 < imu.size() && static_cast<double>((imu[j + 1].time - imu[j].time).ns) < 0.4 * nominal) ++j;
    const double span = static_cast<double>((imu[j].time - imu[i - 1].time).ns);
    const auto n = static_cast<double>(j - i + 1);
    if (j > i && std::abs(span - n * nominal) < 2.0 * nominal + 0.2 * span) {
      const Time start = imu[i - 1].time;
      for (std::size_t k = i; k <= j; ++k) {
        imu[k].time = {start.ns + std::llround(span * static_cast<double>(k - i + 1) / n)};
      }
      if (count == 0) first = start;
      last = imu[j].time;
      count += j - i + 1;
    }
    i = j;
  }
  if (count > 0) {
    record.findings.push_back(
        {"imu", "late batch", first, last, count, Finding::Action::repaired, "spread evenly over the gap before"});
  }
}

}  // namespace

void put_in_order(Recording& r) {
  keep_forward(r.gnss, "gnss", r.record, [](const Fix& f) {
    return std::isfinite(f.position.latitude) && std::isfinite(f.position.longitude) &&
           (!f.speed || std::isfinite(*f.speed));
  });
  keep_forward(r.imu, "imu", r.record,
               [](const InertialSample& s) { return s.acceleration.allFinite() && s.turn_rate.allFinite(); });
  keep_forward(r.speed, "speed", r.record, [](const auto& s) { return std::isfinite(s.speed); });
  spread_batches(r.imu, r.record);
}

void place_on_map(Recording& r, const network::Network& network, const geodesy::Projection& projection) {
  Removed outside{"outside the map's projection"};
  std::vector<Fix> kept;
  kept.reserve(r.gnss.size());
  for (std::size_t i = 0; i < r.gnss.size(); ++i) {
    Fix f = r.gnss[i];
    const auto p = projection.forward(f.position);
    f.place = Eigen::Vector2d(p.easting, p.northing) - network.origin;
    if (f.place.allFinite()) {
      kept.push_back(f);
    } else {
      outside.add(i, f.time);
    }
  }
  outside.report("gnss", r.record);
  r.gnss.samples = std::move(kept);
}

void drop_unused_fixes(Recording& r, const GnssModel& model) {
  Removed unused{"type not used"};
  std::vector<Fix> kept;
  kept.reserve(r.gnss.size());
  for (std::size_t i = 0; i < r.gnss.size(); ++i) {
    const Fix& f = r.gnss[i];
    if (model.sigma_of_type[static_cast<std::size_t>(f.type)] > 0.0) {
      kept.push_back(f);
    } else {
      unused.add(i, f.time);
    }
  }
  unused.report("gnss", r.record);
  r.gnss.samples = std::move(kept);
}

}  // namespace versine::georef
