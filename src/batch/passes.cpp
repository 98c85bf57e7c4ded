// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "pass_knots.hpp"
#include "sqlite.hpp"
#include "versine/batch/catalogue.hpp"

namespace versine::batch {

namespace {
constexpr const char* query_text = R"(
SELECT p.knots, p.probability, j.time_scale, f.uri, j.recording, j.number, u.unit
FROM pass p JOIN journey j ON j.id = p.journey_id JOIN unit u ON u.id = j.unit_id JOIN file f ON f.unit_id = u.id
WHERE p.track_id = ? AND p.low_m <= ? AND p.high_m >= ? AND p.enter_ns <= ? AND p.leave_ns >= ? AND p.probability >= ?
ORDER BY p.enter_ns, p.journey_id, p.number)";

Failure unusable(const std::filesystem::path& path, std::string field, std::string found, std::string expected) {
  return {Exit::usage,
          {.file = path.string(),
           .field = std::move(field),
           .found = std::move(found),
           .expected = std::move(expected),
           .advice = "'versine batch merge --out FILE' writes a catalogue; table 'track' lists its tracks"}};
}

TimeScale scale_of(const std::string& name) {
  return name == "gps" ? TimeScale::gps : name == "utc" ? TimeScale::utc : TimeScale::recorder;
}
}  // namespace

Outcome<std::vector<PassFound>> find_passes(const std::filesystem::path& catalogue, const PassQuery& query) {
  try {
    Database db(catalogue, SQLITE_OPEN_READONLY);
    Statement track(db, "SELECT id FROM track WHERE name = ?");
    if (!track.bind(query.track).step()) {
      return tl::unexpected(unusable(catalogue, "track", "'" + query.track + "'", "a track that was passed"));
    }
    const auto first = query.from.value_or(Time{std::numeric_limits<std::int64_t>::min()});
    const auto last = query.to.value_or(Time{std::numeric_limits<std::int64_t>::max()});
    Statement s(db, query_text);
    s.bind(track.integer(0), query.at, query.at, last.ns, first.ns, query.smallest_probability);
    std::vector<PassFound> out;
    while (s.step()) {
      const auto here = knot_at({{}, 0.0, unpack_knots(s.bytes(0))}, query.at);
      if (!here || here->time < first || last < here->time) continue;
      out.push_back(
          {*here, s.number(1), scale_of(s.text(2)), s.text(3), s.text(4), static_cast<int>(s.integer(5)), s.text(6)});
    }
    return out;
  } catch (const SqliteError& e) {
    return tl::unexpected(unusable(catalogue, "catalogue", e.what(), "a catalogue of 'versine batch merge'"));
  }
}

}  // namespace versine::batch
