// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "time_columns.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::io {

namespace {
using sensors::GaugeSample;
using sensors::HeadingSample;
using sensors::OdometerSample;
using sensors::RangeSample;
using sensors::SpeedSample;

// A table of times and a few numbers: `bind` asks for the columns and returns what makes a sample of a row; that
// returns nothing where a number is missing.
template <class Sample>
using MakeSample = std::function<std::optional<Sample>(const TableReader&, Time)>;

template <class Sample, class Bind>
Expected<Read<Series<Sample>>> read_rows(const TableFile& file, const char* sensor, Bind bind) {
  auto lines = LineReader::open(file.path);
  if (!lines) return tl::unexpected(lines.error());
  const std::string name = lines->name();
  auto opened = TableReader::open(std::move(*lines), file);
  if (!opened) return tl::unexpected(opened.error());
  TableReader& table = *opened;
  auto times = TimeColumns::bind(table, file.clock);
  if (!times) return tl::unexpected(times.error());
  const Expected<MakeSample<Sample>> make = bind(table);
  if (!make) return tl::unexpected(make.error());

  Read<Series<Sample>> read;
  while (table.next()) {
    const auto time = times->read(table);
    if (!time) return tl::unexpected(time.error());
    const auto sample = *time ? (*make)(table, **time) : std::optional<Sample>();
    if (!sample) {
      table.faults().add(*time ? "not a number" : "no time", table.line_number(), "");
      continue;
    }
    table.faults().now(sample->time);
    read.series.samples.push_back(*sample);
  }
  if (table.error()) return fail(*table.error());
  if (const auto fine = table.faults().tolerable(name, read.series.size()); !fine) return tl::unexpected(fine.error());
  table.faults().report(sensor, read.record);
  read.series.scale = times->scale();
  return read;
}

// A sample with one number.
template <class Sample>
Expected<MakeSample<Sample>> one_number(TableReader& table, const char* base, Quantity quantity,
                                        double Sample::*member) {
  const auto slot = table.need(base, quantity);
  if (!slot) return tl::unexpected(slot.error());
  return MakeSample<Sample>([slot = *slot, member](const TableReader& row, Time time) -> std::optional<Sample> {
    Sample sample;
    sample.time = time;
    sample.*member = row.number(slot);
    if (!std::isfinite(sample.*member)) return std::nullopt;
    return sample;
  });
}

/// Steps of a counter, and where a counter of finite width began again.
class Counter {
 public:
  explicit Counter(int bits) : width_(bits > 0 ? std::ldexp(1.0, bits) : 0.0) {}
  double operator()(double count) {
    double step = last_ ? count - *last_ : 0.0;
    if (width_ > 0.0 && step < -width_ / 2.0) step += width_;
    if (width_ > 0.0 && step > width_ / 2.0) step -= width_;
    last_ = count;
    return total_ += step;
  }

 private:
  double width_, total_ = 0.0;
  std::optional<double> last_;
};

/// Two channels a quarter period apart: each change of one of them is a step of +-1. A change of both at once is
/// ambiguous and counts as none.
class Quadrature {
 public:
  double operator()(bool a, bool b) {
    const int phase = a ? (b ? 2 : 1) : (b ? 3 : 0);  // Gray code in the order of forward motion
    if (last_) {
      const int step = (phase - *last_ + 4) % 4;
      total_ += step == 1 ? 1.0 : step == 3 ? -1.0 : 0.0;
    }
    last_ = phase;
    return total_;
  }

 private:
  double total_ = 0.0;
  std::optional<int> last_;
};

Expected<MakeSample<OdometerSample>> bind_odometer(TableReader& table, const OdometerFile& file) {
  if (table.has("distance")) return one_number(table, "distance", Quantity::length, &OdometerSample::distance);
  const double metres = file.metres_per_count;
  if (!(std::abs(metres) > 0.0) || !std::isfinite(metres)) {
    return fail({.file = table.name(),
                 .field = "metres_per_count",
                 .found = "pulses without their length",
                 .expected = "metres per count, other than zero",
                 .advice = "set it to wheel circumference / pulses per turn, or name the column distance_m"});
  }
  if (const auto count = table.find("count", Quantity::none); count && *count) {
    return MakeSample<OdometerSample>([slot = **count, metres, counter = Counter(file.counter_bits)](
                                          const TableReader& row, Time time) mutable -> std::optional<OdometerSample> {
      const double count_now = row.number(slot);
      if (!std::isfinite(count_now)) return std::nullopt;
      return OdometerSample{time, metres * counter(count_now)};
    });
  }
  const auto a = table.find("phase_a", Quantity::none), b = table.find("phase_b", Quantity::none);
  if (a && b && *a && *b) {
    return MakeSample<OdometerSample>([a = **a, b = **b, metres, decoder = Quadrature()](
                                          const TableReader& row, Time time) mutable -> std::optional<OdometerSample> {
      const double x = row.number(a), y = row.number(b);
      if (!std::isfinite(x + y)) return std::nullopt;
      return OdometerSample{time, metres * decoder(x > 0.5, y > 0.5)};
    });
  }
  if (table.header().size() > 1 && !table.has("direction") && table.header().size() > 2) {
    const auto missing = table.need("distance", Quantity::length);  // for its message
    return tl::unexpected(missing.error());
  }
  const auto direction = table.find("direction", Quantity::none);
  if (!direction) return tl::unexpected(direction.error());
  return MakeSample<OdometerSample>([direction = *direction, metres, pulses = 0.0](
                                        const TableReader& row, Time time) mutable -> std::optional<OdometerSample> {
    const double sign = direction ? row.number(*direction) : 1.0;
    if (!std::isfinite(sign)) return std::nullopt;
    pulses += sign < 0.0 ? -1.0 : 1.0;
    return OdometerSample{time, metres * pulses};
  });
}
}  // namespace

Expected<Read<Series<OdometerSample>>> read_odometer(const OdometerFile& file) {
  return read_rows<OdometerSample>(file.table, "odometer", [&](TableReader& t) { return bind_odometer(t, file); });
}

Expected<Read<Series<SpeedSample>>> read_speed(const SpeedFile& file) {
  return read_rows<SpeedSample>(
      file.table, "speed", [](TableReader& t) { return one_number(t, "speed", Quantity::speed, &SpeedSample::speed); });
}

Expected<Read<Series<RangeSample>>> read_range(const RangeFile& file) {
  return read_rows<RangeSample>(file.table, "range", [](TableReader& t) {
    return one_number(t, "range", Quantity::length, &RangeSample::range);
  });
}

Expected<Read<Series<GaugeSample>>> read_gauge(const GaugeFile& file) {
  return read_rows<GaugeSample>(file.table, "gauge", [](TableReader& t) -> Expected<MakeSample<GaugeSample>> {
    const auto gauge = t.need("gauge", Quantity::length);
    if (!gauge) return tl::unexpected(gauge.error());
    const auto temperature = t.find("temperature", Quantity::temperature);
    if (!temperature) return tl::unexpected(temperature.error());
    return MakeSample<GaugeSample>(
        [g = *gauge, c = *temperature](const TableReader& row, Time time) -> std::optional<GaugeSample> {
          GaugeSample sample{.time = time, .reading = row.number(g)};
          if (c && std::isfinite(row.number(*c))) sample.temperature = row.number(*c);
          if (!std::isfinite(sample.reading)) return std::nullopt;
          return sample;
        });
  });
}

Expected<Read<Series<HeadingSample>>> read_heading(const HeadingFile& file) {
  return read_rows<HeadingSample>(file.table, "heading", [&](TableReader& t) -> Expected<MakeSample<HeadingSample>> {
    const auto heading = t.need("heading", Quantity::angle);
    if (!heading) return tl::unexpected(heading.error());
    const auto sigma =
        file.sigma ? Expected<std::optional<TableReader::Slot>>(std::nullopt)
                   : t.need("sigma_heading", Quantity::angle).map([](TableReader::Slot s) { return std::optional(s); });
    if (!sigma) return tl::unexpected(sigma.error());
    if (file.sigma && !(*file.sigma > 0.0)) {
      return fail({.file = t.name(),
                   .field = "sigma_deg",
                   .found = fmt::format("{}", *file.sigma),
                   .expected = "a positive standard deviation",
                   .advice = "give the heading's real one"});
    }
    return MakeSample<HeadingSample>([h = *heading, s = *sigma, given = file.sigma.value_or(0.0)](
                                         const TableReader& row, Time time) -> std::optional<HeadingSample> {
      const double value = row.number(h), deviation = s ? row.number(*s) : given;
      if (!std::isfinite(value + deviation)) return std::nullopt;
      return HeadingSample{time, geodesy::wrap_pi(value), deviation};
    });
  });
}

}  // namespace versine::io
