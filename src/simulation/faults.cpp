// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "versine/core/numbers.hpp"
#include "versine/simulation/world.hpp"

namespace versine::simulation {

namespace {
// The value of a sample: set to another's, to NaN, or shifted.
void take_value(sensors::ImuSample& s, const sensors::ImuSample& from) {
  s.dtheta = from.dtheta, s.dvel = from.dvel;
}
void take_value(sensors::OdometerSample& s, const sensors::OdometerSample& from) {
  s.distance = from.distance;
}
void take_value(sensors::GaugeSample& s, const sensors::GaugeSample& from) {
  s.reading = from.reading;
}
void take_value(sensors::RangeSample& s, const sensors::RangeSample& from) {
  s.range = from.range;
}
void take_value(sensors::GnssSample& s, const sensors::GnssSample& from) {
  s.position = from.position;
}
void shift_value(sensors::ImuSample& s, double by) {
  s.dtheta.array() += by, s.dvel.array() += by;
}
void shift_value(sensors::OdometerSample& s, double by) {
  s.distance += by;
}
void shift_value(sensors::GaugeSample& s, double by) {
  s.reading += by;
}
void shift_value(sensors::RangeSample& s, double by) {
  s.range += by;
}
void shift_value(sensors::GnssSample& s, double by) {
  s.position.height += by;
}

template <class Sample>
std::size_t apply(const Fault& fault, Time from, Time to, std::vector<Sample>& samples) {
  const auto inside = [&](const Sample& s) { return s.time >= from && s.time < to; };
  const auto first = std::find_if(samples.begin(), samples.end(), inside);
  const auto last = std::find_if(first, samples.end(), [&](const Sample& s) { return !inside(s); });
  const auto count = static_cast<std::size_t>(last - first);
  if (count == 0) return 0;
  switch (fault.kind) {
    case Fault::Kind::gap:
      samples.erase(first, last);
      return count;
    case Fault::Kind::duplicate:
      for (auto s = first + 1; s < last; s += 2) s->time = std::prev(s)->time;
      return count / 2;
    case Fault::Kind::reorder:
      for (auto s = first; s + 1 < last; s += 2) std::swap(*s, *(s + 1));
      return count;
    case Fault::Kind::stuck:
      for (auto s = first + 1; s < last; ++s) take_value(*s, *first);
      return count;
    case Fault::Kind::delay: {
      // All samples of a batch arrive with its last one.
      const Duration batch = Duration::from_seconds(fault.amount);
      for (auto s = first; s < last;) {
        auto end = s;
        while (end < last && end->time < s->time + batch) ++end;
        const Time arrival = std::prev(end)->time;
        for (; s < end; ++s) s->time = arrival;
      }
      return count;
    }
    case Fault::Kind::not_a_number:
      for (auto s = first; s < last; ++s) shift_value(*s, nan);
      return count;
    case Fault::Kind::clock_step:
      for (auto s = first; s < samples.end(); ++s) s->time = s->time + Duration::from_seconds(fault.amount);
      return static_cast<std::size_t>(samples.end() - first);
    case Fault::Kind::spike:
      for (auto s = first; s < last; ++s) shift_value(*s, fault.amount);
      return count;
  }
  return 0;
}

const char* to_string(Fault::Kind kind) {
  switch (kind) {
    case Fault::Kind::gap:
      return "gap";
    case Fault::Kind::duplicate:
      return "duplicate time";
    case Fault::Kind::reorder:
      return "out of order";
    case Fault::Kind::stuck:
      return "stuck";
    case Fault::Kind::delay:
      return "batch";
    case Fault::Kind::not_a_number:
      return "not a number";
    case Fault::Kind::clock_step:
      return "clock step";
    case Fault::Kind::spike:
      return "spike";
  }
  return "";
}
}  // namespace

void apply_fault(const Fault& fault, Time start, SimulatedRecording& recording) {
  const Time from = start + Duration::from_seconds(fault.at), to = from + Duration::from_seconds(fault.duration);
  std::string sensor;
  std::size_t count = 0;
  const auto put = [&](const char* name, auto& series) {
    sensor = name;
    count += apply(fault, from, to, series.samples);
  };
  switch (fault.sensor) {
    case Fault::Sensor::imu:
      put("imu", recording.imu);
      break;
    case Fault::Sensor::gauge:
      put("gauge", recording.gauge);
      break;
    case Fault::Sensor::sleeper:
      put("sleeper", recording.sleeper);
      break;
    case Fault::Sensor::gnss:
      put("gnss", recording.gnss);
      break;
    case Fault::Sensor::odometer:
      for (auto& odometer : recording.odometers) put("odometer", odometer);
      break;
  }
  recording.faults.push_back({sensor, to_string(fault.kind), from, to, count, Finding::Action::noted, "put in"});
}

}  // namespace versine::simulation
