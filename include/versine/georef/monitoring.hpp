// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "versine/georef/stamping.hpp"

/// Monitoring data (axle-box acceleration at 20 kHz and the like) put on the track without being rewritten or held in
/// memory: blocks come in, rows of tables go out.
namespace versine::georef {

/// Consecutive samples of a monitoring file.
struct SampleBlock {
  std::uint64_t first = 0;                   ///< number of the first sample in the file, from 0
  std::vector<Time> times;                   ///< increasing, in the recording's time
  std::vector<std::vector<float>> channels;  ///< as many values as times each
};

struct MonitoringOptions {
  double bin = 1.0;            ///< m: length over which RMS and peak are taken, from the line's beginning
  double slowest = 1.0;        ///< m/s: slower samples say nothing about the track, and are left out of RMS and peak
  double tolerance = 1e-3;     ///< m: the table, interpolated linearly, is this near to the movement
  double position_rate = 0.0;  ///< 1/s: exact positions as often; 0: none
};

/// Time to position: between two rows of one journey everything is linear.
struct StampRow {
  Time time;
  double sample = 0.0;  ///< in the file, between two samples with its fraction
  Position position;
};

/// A metre (or another bin) of a track.
struct BinRow {
  std::size_t journey = 0;
  network::TrackIndex track = 0;  ///< its line is the bin's
  double from = 0.0, to = 0.0;    ///< m on the line
  Time time;                      ///< of the first sample
  double speed = 0.0;             ///< mean, m/s
  double sigma = 0.0;             ///< of the distance, m
  double probability = 0.0;       ///< of the path
  std::uint64_t samples = 0;
  struct Channel {
    double rms = 0.0, mean = 0.0;
    double peak = 0.0;     ///< the sample of largest magnitude, with its sign
    double peak_at = 0.0;  ///< m on the line
  };
  std::vector<Channel> channels;
};

/// Use: `add` blocks in order of time, `finish`; take the rows in between.
class MonitoringStamper {
 public:
  MonitoringStamper(const Map& map, const RecordingResult& result, std::size_t channels,
                    const MonitoringOptions& options);

  void add(const SampleBlock& block);
  /// After the last block: the bin that is still open.
  void finish();

  std::vector<StampRow> table;      ///< rows so far; the caller empties it
  std::vector<StampRow> positions;  ///< at the requested rate; the caller empties it
  std::vector<BinRow> bins;         ///< the caller empties it
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] std::uint64_t on_track() const { return on_track_; }  ///< samples within a journey

 private:
  void stamp_rows(const SampleBlock& block, std::size_t i);
  void start_table(Time from);
  void end_table();
  void enter_bin(const PositionCursor::OnJourney& at, Time time);
  void close_bin();

  const Map& map_;
  const RecordingResult& result_;
  MonitoringOptions options_;
  PositionCursor cursor_, rows_;
  std::vector<Time> table_times_;                        // of the journey that the samples are in
  std::size_t next_row_ = 0, table_journey_ = SIZE_MAX;  // SIZE_MAX: none
  std::optional<Time> next_position_;
  std::uint64_t samples_ = 0, on_track_ = 0;
  // The bin that is open, with its reach on the path.
  bool open_ = false;
  double reach_ = 0.0, path_from_ = 0.0, line_from_ = 0.0, sign_ = 1.0, speed_sum_ = 0.0, sigma_sum_ = 0.0;
  std::optional<Time> last_time_;  // of the sample before, in the same journey
  double last_sample_ = 0.0;
  Time last_row_{};
  BinRow bin_;
};

}  // namespace versine::georef
