// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>

#include "versine/filter/consistency.hpp"
#include "versine/filter/kernels.hpp"
#include "versine/fusion/aided_ins.hpp"
#include "versine/fusion/measurement_models.hpp"

namespace versine::fusion::detail {

/// Something measured at a moment of its own.
struct Event {
  enum class Kind { gnss, landmark, heading, odometer, speed };
  Time time;
  Kind kind;
  std::size_t index;
};

/// Events of a segment in order of time. Odometer and speed samples closer than nine tenths of a covariance step are
/// passed over: the next one that is used tells the same distance.
[[nodiscard]] std::vector<Event> events_between(const AidedInsInput& input, const AidedInsOptions& options, Time from,
                                                Time to);

/// Decides on measurements and remembers what it decided: gates, robust weights, sequences, statistics.
class Judge {
 public:
  Judge(const AidedInsOptions& options, AidedInsResult& result)
      : options_(options), result_(result), gate_(options.gate_probability) {}

  enum class Verdict { use, reject, doubt_filter };
  /// S is the innovation's covariance. A robust weight may enlarge `l.R`.
  Verdict judge(const char* sensor, Time time, filter::Linearized& l, const Eigen::Ref<const Eigen::MatrixXd>& S,
                bool often);
  /// A segment begins: nothing is known from before.
  void begin_segment(Time from) { segment_ = from; }
  /// Sums up into the result.
  void finish();

 private:
  struct Sensor {
    std::size_t used = 0, rejected = 0, in_a_row = 0, rows = 0;
    double nis = 0.0;
    Time last_kept{INT64_MIN / 2}, first_in_a_row;
    std::optional<filter::InnovationMonitor> monitor;
    std::optional<std::size_t> finding;
  };
  const AidedInsOptions& options_;
  AidedInsResult& result_;
  filter::Gate gate_;
  Time segment_;
  std::map<std::string, Sensor, std::less<>> sensors_;
};

}  // namespace versine::fusion::detail
