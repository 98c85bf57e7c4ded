// SPDX-License-Identifier: Apache-2.0
#include "versine/sensors/imu_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "order.hpp"

namespace versine::sensors {

namespace {

bool same_values(const ImuSample& a, const ImuSample& b) {
  return a.dtheta == b.dtheta && a.dvel == b.dvel;
}

using Channels = Eigen::Matrix<double, 6, 1>;

Channels channels(const ImuSample& s) {
  return (Channels() << s.dtheta, s.dvel).finished();
}

// Of each channel the smallest change from one sample to the next: one count of a coarse sensor, next to nothing of a
// fine one.
Channels counts(const std::vector<ImuSample>& samples) {
  Channels count = Channels::Constant(std::numeric_limits<double>::infinity());
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Channels a = channels(samples[i - 1]), b = channels(samples[i]);
    for (Eigen::Index k = 0; k < 6; ++k) {
      const double change = std::abs(b[k] - a[k]);
      // Numbers that were meant to be equal differ by the rounding of their scale.
      if (change > 1e-12 * std::abs(a[k]) && change < count[k]) count[k] = change;
    }
  }
  return count;
}

// Marks every sample of a run of unchanged values that lasts longer than `longest`, but its first. Counts of a quiet
// sensor that stands stay for seconds: a run that the values enter or leave by a count or two is no fault.
std::vector<char> hanging(const std::vector<ImuSample>& samples, double longest) {
  std::vector<char> marks(samples.size(), 0);
  if (!(longest > 0.0)) return marks;
  std::optional<Channels> count;
  const auto step = [&](std::size_t a, std::size_t b) {
    if (!count) count = counts(samples);
    const Channels change = (channels(samples[b]) - channels(samples[a])).cwiseAbs();
    return (change.array() <= 2.5 * count->array()).all();
  };
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t j = i + 1;
    while (j < samples.size() && same_values(samples[i], samples[j])) ++j;
    const bool long_run = (samples[j - 1].time - samples[i].time).seconds() > longest;
    if (long_run && !(i > 0 && step(i - 1, i)) && !(j < samples.size() && step(j - 1, j))) {
      for (std::size_t k = i + 1; k < j; ++k) marks[k] = 1;
    }
    i = j;
  }
  return marks;
}

// Leaves out samples whose values cannot be: NaN, no specific force at all, out of range, hanging.
void remove_impossible(ImuSeries& series, const ImuCheckOptions& options, RunRecord& record) {
  using Action = Finding::Action;
  FindingRuns not_number("imu", "not a number", Action::removed), null("imu", "null", Action::removed);
  FindingRuns range("imu", "out of range", Action::removed), stuck("imu", "stuck", Action::removed);
  const double interval = series.interval.seconds();
  const double most_angle = options.max_rate * interval, most_velocity = options.max_acceleration * interval;
  std::vector<ImuSample>& samples = series.samples;
  const std::vector<char> hangs = hanging(samples, options.stuck_after);
  std::size_t to = 0, repeated = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const ImuSample& s = samples[i];
    if (!(s.dtheta.allFinite() && s.dvel.allFinite())) {
      not_number.add(i, s.time);
    } else if (s.dvel.isZero(0.0)) {
      null.add(i, s.time, "no specific force on any axis");
    } else if (!(s.dtheta.cwiseAbs().maxCoeff() <= most_angle) || !(s.dvel.cwiseAbs().maxCoeff() <= most_velocity)) {
      range.add(i, s.time,
                fmt::format("{:.4g} rad/s, {:.4g} m/s^2", s.dtheta.cwiseAbs().maxCoeff() / interval,
                            s.dvel.cwiseAbs().maxCoeff() / interval));
    } else if (hangs[i] != 0) {
      stuck.add(i, s.time, fmt::format("six unchanged values for more than {} s", options.stuck_after));
    } else {
      if (i > 0 && same_values(samples[i - 1], s)) ++repeated;
      samples[to++] = s;
    }
  }
  samples.resize(to);
  for (const FindingRuns* runs : {&not_number, &null, &range, &stuck}) runs->append_to(record);
  if (100 * repeated > to && to > 0) {
    record.findings.push_back({.sensor = "imu",
                               .kind = "repeated",
                               .from = samples.front().time,
                               .to = samples.back().time,
                               .count = repeated,
                               .action = Action::noted,
                               .detail = "samples equal to the one before: the recorder writes faster than the sensor "
                                         "measures, or its resolution is coarse"});
  }
}

/// Builds the output: increments over actual intervals, missing samples interpolated, segments.
class Repair {
 public:
  Repair(const ImuSeries& in, const ImuCheckOptions& options)
      : in_(in), options_(options), interval_(in.interval.seconds()) {}

  CheckedImu run() {
    out_.series.scale = in_.scale;
    out_.series.interval = in_.interval;
    out_.series.samples.reserve(in_.size() + in_.size() / 64);
    for (std::size_t i = 0; i < in_.size(); ++i) {
      if (i == 0) {
        begin_segment(i);
        continue;
      }
      const double step = (in_[i].time - in_[i - 1].time).seconds();
      const double missing = std::round(step / interval_) - 1.0;
      if (missing > static_cast<double>(options_.max_interpolated)) {
        split(i, step);
      } else {
        continue_segment(i, missing > 0.0 ? static_cast<std::size_t>(missing) : 0);
      }
    }
    end_segment();
    interpolated_.append_to(out_.record);
    return std::move(out_);
  }

 private:
  // The increments of the samples are rates times the nominal interval, whatever they came from.
  void push(Time time, const Eigen::Vector3d& dtheta, const Eigen::Vector3d& dvel) {
    out_.series.samples.push_back({time, dtheta, dvel});
  }

  void begin_segment(std::size_t i) {
    segment_begin_ = out_.series.size();
    push(in_[i].time, in_[i].dtheta, in_[i].dvel);
  }

  void continue_segment(std::size_t i, std::size_t missing) {
    const ImuSample &a = in_[i - 1], &b = in_[i];
    const auto parts = static_cast<std::int64_t>(missing + 1);
    const std::int64_t step = (b.time - a.time).ns;
    Eigen::Vector3d before_gyro = a.dtheta, before_accel = a.dvel;
    Time before = a.time;
    for (std::int64_t k = 1; k <= parts; ++k) {
      const Time time = k == parts ? b.time : a.time + Duration{step * k / parts};
      const double w = static_cast<double>(k) / static_cast<double>(parts);
      const Eigen::Vector3d gyro = a.dtheta + w * (b.dtheta - a.dtheta);
      const Eigen::Vector3d accel = a.dvel + w * (b.dvel - a.dvel);
      const double ratio = (time - before).seconds() / interval_;
      if (k < parts) interpolated_.add(out_.series.size(), time, "interpolated");
      if (in_.content == ImuContent::increments) {
        // What the sensor summed up is taken as it is; only what is missing is made up.
        push(time, k < parts ? Eigen::Vector3d(ratio * gyro) : b.dtheta,
             k < parts ? Eigen::Vector3d(ratio * accel) : b.dvel);
      } else if (in_.content == ImuContent::mean_rates) {
        push(time, ratio * gyro, ratio * accel);
      } else {
        push(time, 0.5 * ratio * (before_gyro + gyro), 0.5 * ratio * (before_accel + accel));
      }
      before_gyro = gyro;
      before_accel = accel;
      before = time;
    }
  }

  void split(std::size_t i, double step) {
    end_segment();
    out_.record.findings.push_back({.sensor = "imu",
                                    .kind = "gap",
                                    .from = in_[i - 1].time,
                                    .to = in_[i].time,
                                    .count = static_cast<std::size_t>(std::round(step / interval_)) - 1,
                                    .action = Finding::Action::split,
                                    .detail = fmt::format("{:.3f} s without samples", step)});
    begin_segment(i);
  }

  // A lone sample between two gaps spans nothing and is left out.
  void end_segment() {
    const std::size_t end = out_.series.size();
    if (end - segment_begin_ >= 2) {
      out_.segments.push_back({segment_begin_, end});
    } else if (end > segment_begin_) {
      const Time time = out_.series.back().time;
      out_.series.samples.pop_back();
      out_.record.findings.push_back(
          {"imu", "lone sample", time, time, 1, Finding::Action::removed, "between two gaps"});
    }
  }

  const ImuSeries& in_;
  const ImuCheckOptions& options_;
  double interval_;
  CheckedImu out_;
  std::size_t segment_begin_ = 0;
  FindingRuns interpolated_{"imu", "gap", Finding::Action::repaired};
};

}  // namespace

Expected<CheckedImu> check_imu(ImuSeries series, const ImuCheckOptions& options) {
  const auto too_short = [&](std::string found) {
    return fail({.file = options.file,
                 .found = std::move(found),
                 .expected = "at least two good samples",
                 .advice = "check units and axes in the file's description; see the findings of 'versine info'"});
  };
  if (series.size() < 2 || !(series.interval > Duration{})) return too_short(fmt::format("{} samples", series.size()));
  RunRecord record;
  const std::size_t total = series.size();
  remove_impossible(series, options, record);
  if (const auto fine = put_in_order(series.samples, "imu", options.file, options.max_disorder, record); !fine) {
    return tl::unexpected(fine.error());
  }
  if (2 * series.size() < total || series.size() < 2) {
    const std::string most = record.findings.empty() ? "" : ", first: " + record.findings.front().kind;
    return too_short(fmt::format("{} of {} samples unusable{}", total - series.size(), total, most));
  }
  CheckedImu checked = Repair(series, options).run();
  if (checked.segments.empty()) return too_short("nothing but lone samples between gaps");
  record.append(std::move(checked.record));
  checked.record = std::move(record);
  return checked;
}

}  // namespace versine::sensors
