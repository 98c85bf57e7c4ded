// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "versine/app/georef.hpp"
#include "versine/io/monitoring_file.hpp"
#include "versine/io/monitoring_result.hpp"

namespace versine::app {

namespace {
Expected<const georef::RecordingResult*> result_for(const MonitoringConfig& m,
                                                    const std::vector<GeorefOutcome>& outcomes) {
  const auto index = static_cast<std::size_t>(m.recording) - 1;
  if (index < outcomes.size() && outcomes[index].result) return &*outcomes[index].result;
  return fail({.file = m.file.written,
               .field = "monitoring.recording",
               .found = index < outcomes.size() ? "a recording without result: " + outcomes[index].result.error().found
                                                : fmt::format("{}", m.recording),
               .expected = fmt::format("1 to {}", outcomes.size()),
               .advice = "name the recording that was made on the same vehicle"});
}

/// Nothing of the file lies within a journey: its clock is another one.
Error apart(const MonitoringConfig& m, const georef::RecordingResult& r, Time from, Time to) {
  std::string journeys = "none";
  if (!r.journeys.empty()) {
    journeys = fmt::format("{:.1f} to {:.1f} s", r.journeys.front().start.seconds(), r.journeys.back().end().seconds());
  }
  return {.file = m.file.written,
          .field = "times",
          .found = fmt::format("samples from {:.1f} to {:.1f} s", from.seconds(), to.seconds()),
          .expected = "samples within the journeys: " + journeys,
          .advice = "set offset_s (or start_s) so that both clocks agree"};
}
}  // namespace

Expected<void> stamp_monitoring(const std::filesystem::path& folder, const georef::Map& map,
                                const std::vector<GeorefOutcome>& outcomes, const std::vector<MonitoringConfig>& files,
                                Progress& progress) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    const MonitoringConfig& m = files[i];
    const auto result = result_for(m, outcomes);
    if (!result) return tl::unexpected(result.error());
    auto reader = io::MonitoringReader::open({m.file.path, m.channels, m.times, m.rate_hz, m.start, m.offset, m.scale});
    if (!reader) return tl::unexpected(reader.error());
    auto out =
        io::MonitoringResult::create(folder / fmt::format("monitoring_{}.h5", i + 1), m.file.written, map, m.channels);
    if (!out) return tl::unexpected(out.error());
    georef::MonitoringStamper stamper(map, **result, m.channels.size(), m.options);
    georef::SampleBlock block;
    Time first, last;
    for (bool more = true; more;) {
      const auto read = reader->next(block);
      if (!read) return tl::unexpected(read.error());
      more = *read;
      if (!more) break;
      if (stamper.samples() == 0) first = block.times.front();
      last = block.times.back();
      stamper.add(block);
      out->take(stamper);
      if (progress.cancelled()) return fail({.found = "cancelled"});
      if (reader->samples() > 0) {
        progress.report("monitoring", static_cast<double>(stamper.samples()) / static_cast<double>(reader->samples()));
      }
    }
    stamper.finish();
    out->take(stamper);
    if (stamper.on_track() == 0) return fail(apart(m, **result, first, last));
    if (const auto closed = out->close(); !closed) return closed;
  }
  return {};
}

}  // namespace versine::app
