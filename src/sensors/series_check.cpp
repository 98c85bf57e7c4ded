// SPDX-License-Identifier: Apache-2.0
#include "versine/sensors/series_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "order.hpp"

namespace versine::sensors {

namespace {
using Action = Finding::Action;
using Options = SeriesCheckOptions;

// Leaves out the samples of which `kind_of` says what is wrong (null: nothing).
template <class Sample, class KindOf>
void remove_bad(std::vector<Sample>& samples, const std::string& sensor, RunRecord& record, KindOf kind_of) {
  std::vector<std::pair<const char*, FindingRuns>> runs;
  std::size_t to = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const char* const kind = kind_of(samples[i]);
    if (kind == nullptr) {
      if (to != i) samples[to] = std::move(samples[i]);
      ++to;
      continue;
    }
    auto run = std::find_if(runs.begin(), runs.end(), [&](const auto& r) { return r.first == kind; });
    if (run == runs.end()) run = runs.insert(run, {kind, FindingRuns(sensor, kind, Action::removed)});
    run->second.add(i, samples[i].time);
  }
  samples.resize(to);
  for (const auto& [kind, run] : runs) run.append_to(record);
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Hampel's identifier: the median of the window replaces what lies too far from it.
template <class Sample>
void remove_spikes(std::vector<Sample>& samples, double Sample::*member, const std::string& sensor,
                   const Options& options, RunRecord& record) {
  if (!(options.spike > 0.0) || options.window < 3 || samples.size() < options.window) return;
  FindingRuns spikes(sensor, "spike", Action::repaired);
  const std::size_t half = options.window / 2, width = 2 * half + 1;
  std::vector<double> original, window(width), deviation(width);
  for (const Sample& s : samples) original.push_back(s.*member);
  for (std::size_t i = 0; i < original.size(); ++i) {
    const std::size_t begin = std::min(i > half ? i - half : 0, original.size() - width);
    std::copy_n(original.begin() + static_cast<std::ptrdiff_t>(begin), width, window.begin());
    const double centre = median(window);
    const double off = std::abs(original[i] - centre);
    if (!(off > options.spike)) continue;
    for (std::size_t k = 0; k < width; ++k) deviation[k] = std::abs(window[k] - centre);
    if (!(off > 6.0 * 1.4826 * median(deviation))) continue;
    spikes.add(i, samples[i].time, fmt::format("{:.6g} replaced by {:.6g}", original[i], centre));
    samples[i].*member = centre;
  }
  spikes.append_to(record);
}

template <class Sample>
void remove_stuck(std::vector<Sample>& samples, double Sample::*member, const std::string& sensor,
                  const Options& options, RunRecord& record) {
  if (!(options.stuck_after > 0.0)) return;
  FindingRuns stuck(sensor, "stuck", Action::removed);
  std::vector<Sample> kept;
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t j = i + 1;
    while (j < samples.size() && samples[j].*member == samples[i].*member) ++j;
    const bool hangs = (samples[j - 1].time - samples[i].time).seconds() > options.stuck_after;
    for (std::size_t k = i; k < j; ++k) {
      if (hangs && k > i) {
        stuck.add(k, samples[k].time, fmt::format("{:.6g} unchanged", samples[i].*member));
      } else {
        kept.push_back(samples[k]);
      }
    }
    i = j;
  }
  samples = std::move(kept);
  stuck.append_to(record);
}

template <class Sample>
Expected<void> enough(const std::vector<Sample>& samples, std::size_t total, const Options& options) {
  if (!samples.empty()) return {};
  return fail(
      {.file = options.file,
       .found = total == 0 ? std::string("no samples") : fmt::format("{} samples, none of them usable", total),
       .expected = "at least one good sample",
       .advice = "check units and columns in the file's description; 'versine info' shows what is in the file"});
}

// The common part of signals with one value.
template <class Sample>
Expected<Checked<Sample>> check_signal(Series<Sample> series, double Sample::*member, const std::string& sensor,
                                       const Options& options) {
  Checked<Sample> out;
  const std::size_t total = series.size();
  remove_bad(series.samples, sensor, out.record, [&](const Sample& s) -> const char* {
    if (!std::isfinite(s.*member)) return "not a number";
    return s.*member < options.min || s.*member > options.max ? "out of range" : nullptr;
  });
  if (const auto fine = put_in_order(series.samples, sensor, options.file, options.max_disorder, out.record); !fine) {
    return tl::unexpected(fine.error());
  }
  remove_stuck(series.samples, member, sensor, options, out.record);
  remove_spikes(series.samples, member, sensor, options, out.record);
  if (const auto fine = enough(series.samples, total, options); !fine) return tl::unexpected(fine.error());
  out.series = std::move(series);
  return out;
}

Error bad_sigma(const std::string& sensor, const Options& options, Time time, double sigma) {
  return {.file = options.file,
          .field = sensor + " sigma",
          .found = fmt::format("{} at {} s", sigma, time.seconds()),
          .expected = "a positive standard deviation",
          .advice = "give the real one; leave the column out to set one for the whole file"};
}

const char* fault_of(const geodesy::Geodetic& g) {
  if (!std::isfinite(g.latitude + g.longitude + g.height)) return "not a number";
  if (g.latitude == 0.0 && g.longitude == 0.0) return "null";
  const bool on_earth = std::abs(g.latitude) <= std::numbers::pi / 2 && std::abs(g.longitude) <= 2 * std::numbers::pi &&
                        g.height > -1000.0 && g.height < 20000.0;
  return on_earth ? nullptr : "out of range";
}

// A receiver that hangs repeats its position while it says that it moves.
void remove_frozen(std::vector<GnssSample>& samples, RunRecord& record) {
  FindingRuns frozen("gnss", "stuck", Action::removed);
  std::vector<GnssSample> kept;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    bool stuck = false;
    if (!kept.empty() && samples[i].v_ned && samples[i].position == samples[i - 1].position) {
      const double moved = samples[i].v_ned->norm() * (samples[i].time - samples[i - 1].time).seconds();
      stuck = moved > 0.5 + 5.0 * samples[i].sigma_ned.norm();
    }
    if (stuck) {
      frozen.add(i, samples[i].time, "position unchanged at speed");
    } else {
      kept.push_back(samples[i]);
    }
  }
  samples = std::move(kept);
  frozen.append_to(record);
}
}  // namespace

Expected<Checked<GnssSample>> check_gnss(Series<GnssSample> series, const Options& options) {
  for (const GnssSample& s : series) {
    for (const double sigma : s.sigma_ned) {
      if (sigma <= 0.0) return fail(bad_sigma("gnss", options, s.time, sigma));
    }
  }
  Checked<GnssSample> out;
  const std::size_t total = series.size();
  remove_bad(series.samples, "gnss", out.record, [](const GnssSample& s) -> const char* {
    if (s.fix == FixType::none) return "no fix";
    if (!s.sigma_ned.allFinite()) return "not a number";
    return fault_of(s.position);
  });
  for (GnssSample& s : series.samples) {
    if (s.v_ned && !(s.v_ned->allFinite() && s.sigma_v_ned.minCoeff() > 0.0)) s.v_ned.reset();
  }
  if (const auto fine = put_in_order(series.samples, "gnss", options.file, options.max_disorder, out.record); !fine) {
    return tl::unexpected(fine.error());
  }
  remove_frozen(series.samples, out.record);
  if (const auto fine = enough(series.samples, total, options); !fine) return tl::unexpected(fine.error());
  out.series = std::move(series);
  return out;
}

Expected<Checked<OdometerSample>> check_odometer(Series<OdometerSample> series, const Options& options) {
  return check_signal(std::move(series), &OdometerSample::distance, "odometer", options);
}

Expected<Checked<SpeedSample>> check_speed(Series<SpeedSample> series, const Options& options) {
  return check_signal(std::move(series), &SpeedSample::speed, "speed", options);
}

Expected<Checked<GaugeSample>> check_gauge(Series<GaugeSample> series, const Options& options) {
  return check_signal(std::move(series), &GaugeSample::reading, "gauge", options);
}

Expected<Checked<RangeSample>> check_range(Series<RangeSample> series, const Options& options) {
  return check_signal(std::move(series), &RangeSample::range, "range", options);
}

Expected<Checked<HeadingSample>> check_heading(Series<HeadingSample> series, const Options& options) {
  for (const HeadingSample& s : series) {
    if (!(s.sigma > 0.0)) return fail(bad_sigma("heading", options, s.time, s.sigma));
  }
  return check_signal(std::move(series), &HeadingSample::heading, "heading", options);
}

Expected<Checked<LandmarkSample>> check_landmarks(Series<LandmarkSample> series, const Options& options) {
  for (const LandmarkSample& s : series) {
    const double least = s.covariance.diagonal().minCoeff();
    if (!(least > 0.0)) {
      return fail(bad_sigma("landmark '" + s.name + "'", options, s.time, std::min(least, 0.0)));
    }
  }
  Checked<LandmarkSample> out;
  const std::size_t total = series.size();
  remove_bad(series.samples, "landmark", out.record, [](const LandmarkSample& s) { return fault_of(s.position); });
  if (const auto fine = put_in_order(series.samples, "landmark", options.file, options.max_disorder, out.record);
      !fine) {
    return tl::unexpected(fine.error());
  }
  if (const auto fine = enough(series.samples, total, options); !fine) return tl::unexpected(fine.error());
  out.series = std::move(series);
  return out;
}

}  // namespace versine::sensors
