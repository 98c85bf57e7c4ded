// SPDX-License-Identifier: Apache-2.0
#include "aids.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace versine::fusion::detail {

std::vector<Event> events_between(const AidedInsInput& in, const AidedInsOptions& o, Time from, Time to) {
  std::vector<Event> events;
  const auto add = [&](const auto& series, Event::Kind kind, Duration spacing) {
    Time last{INT64_MIN / 2};
    for (std::size_t i = series.lower_bound({from.ns + 1}); i < series.size() && series[i].time <= to; ++i) {
      if (series[i].time - last < spacing) continue;
      events.push_back({series[i].time, kind, i});
      last = series[i].time;
    }
  };
  const Duration step = Duration::from_seconds(0.9 / o.covariance_rate);
  if (o.use_gnss_position || o.use_gnss_velocity) add(in.gnss, Event::Kind::gnss, {});
  add(in.landmarks, Event::Kind::landmark, {});
  add(in.heading, Event::Kind::heading, step);
  if (o.odometer_use == OdometerUse::distance) add(in.odometer, Event::Kind::odometer, step);
  add(in.speed, Event::Kind::speed, step);
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.time < b.time; });
  return events;
}

Judge::Verdict Judge::judge(const char* name, Time time, filter::Linearized& l,
                            const Eigen::Ref<const Eigen::MatrixXd>& S, bool often) {
  Sensor& sensor = sensors_[name];
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  const Eigen::VectorXd whitened = llt.matrixL().solve(l.z);
  const double nis = whitened.squaredNorm(), limit = gate_.threshold(l.rows());
  // Written so that a NaN is rejected.
  bool good = llt.info() == Eigen::Success && nis <= limit;
  Verdict verdict = good ? Verdict::use : Verdict::reject;
  // An instrument's attitude that never fits says that its mounting is wrong, not the filter.
  const bool mounting = std::string_view(name) == "landmark attitude";
  if (sensor.in_a_row == 0) sensor.first_in_a_row = time;
  // A segment that has only begun has no better knowledge than the sensor that contradicts it.
  const double trusted = options_.doubt_after > 0.0
                             ? options_.doubt_after
                             : std::clamp(std::sqrt(2.0 * 0.3 / options_.imu_errors.accelerometer.bias), 1.0, 60.0);
  const double patience = std::min(trusted, (sensor.first_in_a_row - segment_).seconds());
  if (!good && !mounting && std::isfinite(nis) && options_.most_rejections > 0 &&
      sensor.in_a_row + 1 >= static_cast<std::size_t>(options_.most_rejections) &&
      (often || (time - sensor.first_in_a_row).seconds() >= patience)) {
    verdict = Verdict::doubt_filter;
    result_.solution.record.warnings.push_back(
        fmt::format("{} rejected {} times in a row until {:.3f} s: the filter's covariance was enlarged instead", name,
                    sensor.in_a_row + 1, time.seconds()));
  }
  if (good) {
    sensor.in_a_row = 0;
    ++sensor.used;
    sensor.rows += static_cast<std::size_t>(l.rows());
    sensor.nis += nis;
    if (options_.robust == RobustWeight::huber) {
      const double k = 1.5 * 1.5 * l.rows();  // Huber's corner at 1.5 sigma a row
      if (nis > k) l.R *= std::sqrt(nis / k);
    }
    // What wheels wander is alike over more readings than are watched: no slow fault.
    if (options_.monitor_length > 1 && std::string_view(name) != "wheel path") {
      if (!sensor.monitor) sensor.monitor.emplace(options_.monitor_length, 1e-6);
      if (sensor.monitor->add(whitened)) {
        auto& findings = result_.solution.record.findings;
        if (!sensor.finding) {
          sensor.finding = findings.size();
          findings.push_back({name, "innovation mean", time, time, 0, Finding::Action::noted,
                              fmt::format("mean of {} innovations beyond chance (chi-square {:.1f} of {} rows): a slow "
                                          "fault, or a noise that is not white",
                                          options_.monitor_length, sensor.monitor->statistic(), l.rows())});
        }
        findings[*sensor.finding].to = time;
        ++findings[*sensor.finding].count;
      }
    }
  } else {
    sensor.in_a_row = verdict == Verdict::doubt_filter ? 0 : sensor.in_a_row + 1;
    ++sensor.rejected;
    result_.solution.record.rejections.push_back({name, time, "innovation", std::sqrt(nis), std::sqrt(limit)});
  }
  const bool keep = !good || !often || (time - sensor.last_kept).seconds() >= options_.innovation_interval;
  if (keep) {
    sensor.last_kept = time;
    result_.solution.innovations.push_back(
        {time, name, (-l.z).cast<float>(), S.diagonal().cwiseSqrt().cast<float>(), nis, good});
  }
  return verdict;
}

void Judge::finish() {
  for (const auto& [name, s] : sensors_) {
    SensorStatistics statistics{name, s.used, s.rejected, 0.0, 0.0, 0.0};
    if (s.rows > 0) {
      statistics.mean_nis_per_row = s.nis / static_cast<double>(s.rows);
      const filter::Bounds b = filter::mean_chi_square_bounds(s.rows, 1.0);
      statistics.lower = b.lower;
      statistics.upper = b.upper;
    }
    result_.statistics.push_back(statistics);
  }
}

}  // namespace versine::fusion::detail
