// SPDX-License-Identifier: Apache-2.0
#include "versine/georef/monitoring.hpp"

#include <algorithm>
#include <cmath>

namespace versine::georef {

namespace {
/// Times between which a journey's distance is linear to `tolerance`, with a row at each change of track.
std::vector<Time> linear_pieces(const JourneyResult& j, double tolerance) {
  const auto& d = j.paths.front().motion.distance;
  const auto& starts = j.paths.front().coordinates.starts();
  const auto straight = [&](std::size_t a, std::size_t b) {
    const std::size_t step = std::max<std::size_t>(1, (b - a) / 16);
    for (std::size_t k = a + step; k < b; k += step) {
      const double u = static_cast<double>(k - a) / static_cast<double>(b - a);
      if (std::abs(d[a] + u * (d[b] - d[a]) - d[k]) > tolerance) return false;
    }
    return true;
  };
  std::vector<Time> out;
  const auto put = [&](double step) { out.push_back(j.start + Duration::from_seconds(j.grid * step)); };
  const auto longest = static_cast<std::size_t>(std::max(1.0, 8.0 / j.grid));
  put(0.0);
  std::size_t piece = 1;
  for (std::size_t a = 0; a + 1 < j.steps;) {
    std::size_t b = std::min(a + longest, j.steps - 1);
    while (b > a + 1 && !straight(a, b)) b = a + (b - a) / 2;
    // A row on each side of a joint: there the track changes.
    for (; piece + 1 < starts.size() && starts[piece] <= d[b]; ++piece) {
      const auto it = std::lower_bound(d.begin() + static_cast<std::ptrdiff_t>(a), d.end(), starts[piece]);
      const auto k = static_cast<std::size_t>(it - d.begin());
      if (k == 0 || d[k] == d[k - 1] || starts[piece] <= d[a]) continue;
      const double step = static_cast<double>(k - 1) + (starts[piece] - d[k - 1]) / (d[k] - d[k - 1]);
      const Time before = j.start + Duration{Duration::from_seconds(j.grid * step).ns - 1000};
      if (out.back() < before) out.push_back(before);
      if (const Time after = before + Duration{2000}; out.back() < after) out.push_back(after);
    }
    a = b;
    if (const Time t = j.start + Duration::from_seconds(j.grid * static_cast<double>(a)); out.back() < t) {
      out.push_back(t);
    }
  }
  return out;
}
}  // namespace

MonitoringStamper::MonitoringStamper(const Map& map, const RecordingResult& result, std::size_t channels,
                                     const MonitoringOptions& options)
    : map_(map), result_(result), options_(options), cursor_(map, result), rows_(map, result) {
  bin_.channels.resize(channels);
}

void MonitoringStamper::add(const SampleBlock& block) {
  samples_ += block.times.size();
  for (std::size_t i = 0; i < block.times.size(); ++i) {
    const Time t = block.times[i];
    const auto at = cursor_.on_journey(t);
    if (!at || at->journey != table_journey_) end_table();
    if (!at) {
      if (open_) close_bin();
      continue;
    }
    ++on_track_;
    stamp_rows(block, i);
    last_time_ = t, last_sample_ = static_cast<double>(block.first + i);
    if (at->speed < options_.slowest) continue;
    if (!open_ || at->journey != bin_.journey || !(at->distance < reach_)) enter_bin(*at, t);
    ++bin_.samples;
    speed_sum_ += at->speed, sigma_sum_ += at->sigma;
    for (std::size_t c = 0; c < bin_.channels.size(); ++c) {
      const double x = block.channels[c][i];
      auto& channel = bin_.channels[c];
      channel.mean += x, channel.rms += x * x;
      if (std::abs(x) > std::abs(channel.peak) || bin_.samples == 1) {
        channel.peak = x;
        channel.peak_at = line_from_ + sign_ * (at->distance - path_from_);
      }
    }
  }
}

void MonitoringStamper::finish() {
  end_table();
  if (open_) close_bin();
}

void MonitoringStamper::end_table() {
  if (table_journey_ != SIZE_MAX && last_time_ && last_row_ < *last_time_) {
    if (const auto p = rows_.at(*last_time_)) table.push_back({*last_time_, last_sample_, *p});
  }
  table_journey_ = SIZE_MAX;
  last_time_.reset();
}

void MonitoringStamper::start_table(Time from) {
  const JourneyResult& j = result_.journeys[table_journey_];
  table_times_ = linear_pieces(j, options_.tolerance);
  const auto it = std::lower_bound(table_times_.begin(), table_times_.end(), from);
  // The table begins with the file's first sample in the journey.
  table_times_.erase(table_times_.begin(), it);
  if (table_times_.empty() || from < table_times_.front()) table_times_.insert(table_times_.begin(), from);
  next_row_ = 0;
}

void MonitoringStamper::stamp_rows(const SampleBlock& block, std::size_t i) {
  const Time t = block.times[i];
  const std::size_t journey = cursor_.journey();
  if (journey != table_journey_) table_journey_ = journey, start_table(t);
  const auto sample = [&](Time at) {
    const double here = static_cast<double>(block.first + i);
    if (!last_time_ || !(*last_time_ < t)) return here;
    return here - static_cast<double>((t - at).ns) / static_cast<double>((t - *last_time_).ns);
  };
  for (; next_row_ < table_times_.size() && !(t < table_times_[next_row_]); ++next_row_) {
    const Time at = table_times_[next_row_];
    if (const auto p = rows_.at(at)) table.push_back({at, sample(at), *p}), last_row_ = at;
  }
  if (!(options_.position_rate > 0.0)) return;
  if (!next_position_ || *next_position_ + Duration::from_seconds(1.0) < t) next_position_ = t;
  const auto step = Duration::from_seconds(1.0 / options_.position_rate);
  for (; !(t < *next_position_); next_position_ = *next_position_ + step) {
    if (const auto p = rows_.at(*next_position_)) positions.push_back({*next_position_, sample(*next_position_), *p});
  }
}

void MonitoringStamper::enter_bin(const PositionCursor::OnJourney& at, Time time) {
  const Position p = cursor_.place(at);
  const auto& path = result_.journeys[at.journey].paths.front().coordinates;
  sign_ = p.track.reversed ? -1.0 : 1.0;
  path_from_ = at.distance, line_from_ = p.track_distance;
  // A place exactly on a border belongs to the bin that is entered there.
  const double k = sign_ > 0.0 ? std::floor(p.track_distance / options_.bin + 1e-9)
                               : std::ceil(p.track_distance / options_.bin - 1e-9) - 1.0;
  const double from = k * options_.bin, to = from + options_.bin;
  reach_ = std::min(at.distance + (sign_ > 0.0 ? to - p.track_distance : p.track_distance - from),
                    path.starts()[p.index_on_path + 1]);
  const auto& tracks = map_.network.tracks;
  if (open_ && at.journey == bin_.journey && from == bin_.from &&
      tracks[p.track.track].line_id == tracks[bin_.track].line_id) {
    return;  // the same metre behind a switch
  }
  if (open_) close_bin();
  const std::size_t channels = bin_.channels.size();
  bin_ = {};
  bin_.channels.resize(channels);
  bin_.journey = at.journey, bin_.track = p.track.track, bin_.time = time, bin_.probability = p.probability;
  bin_.from = from, bin_.to = to;
  open_ = true;
  speed_sum_ = sigma_sum_ = 0.0;
}

void MonitoringStamper::close_bin() {
  const auto n = static_cast<double>(bin_.samples);
  for (auto& c : bin_.channels) {
    c.mean /= n;
    c.rms = std::sqrt(c.rms / n);
  }
  bin_.speed = speed_sum_ / n, bin_.sigma = sigma_sum_ / n;
  bins.push_back(bin_);
  open_ = false;
}

}  // namespace versine::georef
