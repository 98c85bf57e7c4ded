// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pass_knots.hpp"
#include "sqlite.hpp"
#include "versine/batch/catalogue.hpp"
#include "versine/batch/receipt.hpp"
#include "versine/core/file_system.hpp"

namespace versine::batch {

namespace fs = std::filesystem;

namespace {
// No time, host or path of the run: the same results make the same bytes. One row a pass; `pass` is stored in the order
// in which it is asked for.
constexpr const char* schema = R"(
PRAGMA page_size = 4096;
PRAGMA journal_mode = OFF;
PRAGMA synchronous = OFF;
CREATE TABLE about(key TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID;
CREATE TABLE unit(id INTEGER PRIMARY KEY, unit TEXT NOT NULL, state TEXT NOT NULL, shard INTEGER NOT NULL);
CREATE TABLE file(unit_id INTEGER NOT NULL, uri TEXT NOT NULL, sha256 TEXT NOT NULL, bytes INTEGER NOT NULL);
CREATE TABLE output(unit_id INTEGER NOT NULL, name TEXT NOT NULL, sha256 TEXT NOT NULL, bytes INTEGER NOT NULL);
CREATE TABLE journey(
  id INTEGER PRIMARY KEY, unit_id INTEGER NOT NULL, recording TEXT NOT NULL, number INTEGER NOT NULL,
  time_scale TEXT NOT NULL, from_ns INTEGER NOT NULL, to_ns INTEGER NOT NULL, length_m REAL NOT NULL,
  path TEXT NOT NULL, probability REAL NOT NULL, runner_up TEXT, runner_up_probability REAL, entropy_nat REAL NOT NULL,
  fixes INTEGER NOT NULL, rejected INTEGER NOT NULL, mean_nis REAL NOT NULL, sigma_rms_m REAL NOT NULL,
  sigma_max_m REAL NOT NULL);
CREATE TABLE failure(unit_id INTEGER NOT NULL, recording TEXT NOT NULL, line INTEGER NOT NULL, field TEXT NOT NULL,
  found TEXT NOT NULL, expected TEXT NOT NULL, advice TEXT NOT NULL);
CREATE TABLE track(id INTEGER PRIMARY KEY, name TEXT UNIQUE NOT NULL);
CREATE TABLE pass(
  track_id INTEGER NOT NULL, enter_ns INTEGER NOT NULL, journey_id INTEGER NOT NULL, number INTEGER NOT NULL,
  leave_ns INTEGER NOT NULL, low_m REAL NOT NULL, high_m REAL NOT NULL, enter_mps REAL NOT NULL, leave_mps REAL NOT NULL,
  probability REAL NOT NULL, knots BLOB NOT NULL,
  PRIMARY KEY(track_id, enter_ns, journey_id, number)) WITHOUT ROWID;
BEGIN;
)";

constexpr const char* indices = R"(
CREATE INDEX journey_from ON journey(from_ns);
CREATE INDEX file_unit ON file(unit_id);
CREATE INDEX output_unit ON output(unit_id);
COMMIT;
)";

const char* name_of(TimeScale scale) {
  return scale == TimeScale::gps ? "gps" : scale == TimeScale::utc ? "utc" : "recorder";
}

/// Statements can be prepared when the tables are there.
Database with_tables(const fs::path& path) {
  Database db(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  db.run(schema);
  return db;
}

class Writer {
 public:
  explicit Writer(const fs::path& path) : db_(with_tables(path)) {}

  void about(const Manifest& m, bool complete) {
    Statement s(db_, "INSERT INTO about VALUES(?, ?)");
    for (const auto& [key, value] : std::map<std::string, std::string>{{"format", "versine catalogue 1"},
                                                                       {"manifest", m.id},
                                                                       {"engine", m.engine},
                                                                       {"config", m.job.config},
                                                                       {"stage", m.stage},
                                                                       {"complete", complete ? "1" : "0"}}) {
      s.bind(key, value).step();
    }
  }

  void unit(const Unit& u, const Receipt* receipt) {
    const char* state = receipt == nullptr ? "open" : receipt->rejection ? "rejected" : "done";
    unit_.bind(++unit_id_, u.unit, state, u.shard).step();
    for (const Input& i : u.inputs) file_.bind(unit_id_, i.uri, i.sha256, i.bytes).step();
    if (receipt == nullptr) return;
    for (const Output& o : receipt->outputs) output_.bind(unit_id_, o.name, o.sha256, o.bytes).step();
    if (receipt->rejection) failure({{}, *receipt->rejection});
  }

  void failure(const FailureEntry& f) {
    const Error& e = f.error;
    failure_.bind(unit_id_, f.recording, e.line, e.field, e.found, e.expected, e.advice).step();
    ++failures;
  }

  void journey(const JourneyEntry& j) {
    const std::int64_t id = ++journey_id_;
    const auto put = [&](const auto& runner_up, const auto& probability) {
      const PathEntry best = j.paths.empty() ? PathEntry{} : j.paths.front();
      journey_
          .bind(id, unit_id_, j.recording, j.number, name_of(j.scale), j.from.ns, j.to.ns, j.length, best.tracks,
                best.probability, runner_up, probability, j.entropy, j.fixes, j.rejected, j.mean_nis, j.sigma_rms,
                j.sigma_max)
          .step();
    };
    if (j.paths.size() > 1) {
      put(j.paths[1].tracks, j.paths[1].probability);
    } else {
      put(nullptr, nullptr);
    }
    for (std::size_t i = 0; i < j.passes.size(); ++i) pass(id, i, j.passes[i]);
  }

  void close() {
    db_.run(indices);
    finish();
  }

  std::int64_t unit_id_ = 0, journey_id_ = 0;
  std::size_t passes = 0, failures = 0;

 private:
  void pass(std::int64_t journey, std::size_t number, const Pass& p) {
    const Knot &a = p.knots.front(), &b = p.knots.back();
    pass_
        .bind(track(p.track), a.time.ns, journey, number, b.time.ns, std::min(a.distance, b.distance),
              std::max(a.distance, b.distance), std::abs(a.speed), std::abs(b.speed), p.probability,
              Statement::blob(pack_knots(p.knots)))
        .step();
    ++passes;
  }

  std::int64_t track(const std::string& name) {
    const auto [it, fresh] = tracks_.emplace(name, static_cast<std::int64_t>(tracks_.size()) + 1);
    if (fresh) track_.bind(it->second, name).step();
    return it->second;
  }

  void finish() {
    // Statements first: a database with open ones does not close.
    for (Statement* s : {&unit_, &file_, &output_, &journey_, &failure_, &track_, &pass_}) s->release();
    db_.close();
  }

  Database db_;
  Statement unit_{db_, "INSERT INTO unit VALUES(?, ?, ?, ?)"}, file_{db_, "INSERT INTO file VALUES(?, ?, ?, ?)"},
      output_{db_, "INSERT INTO output VALUES(?, ?, ?, ?)"},
      journey_{db_, "INSERT INTO journey VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"},
      failure_{db_, "INSERT INTO failure VALUES(?, ?, ?, ?, ?, ?, ?)"}, track_{db_, "INSERT INTO track VALUES(?, ?)"},
      pass_{db_, "INSERT INTO pass VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"};
  std::map<std::string, std::int64_t> tracks_;
};

Outcome<std::optional<Summary>> summary_of(const Store& store, const Receipt& receipt) {
  for (const Output& o : receipt.outputs) {
    if (o.name != "summary") continue;
    const auto bytes = store.get(o.sha256);
    if (!bytes) return failure(Exit::incomplete, bytes.error().error);
    auto summary = summary_from(*bytes);
    if (!summary) return failure(Exit::again, summary.error());
    return std::optional(std::move(*summary));
  }
  return std::optional<Summary>();
}

Outcome<Merged> fill(Writer& writer, const Store& store, const Manifest& m, bool partial) {
  Merged out;
  for (const Unit& u : m.units) {
    const auto receipt = find_receipt(store, u.unit);
    if (!receipt) return failure(Exit::incomplete, receipt.error().error);
    if (!*receipt) ++out.open;
    if (!*receipt && !partial) continue;
    writer.unit(u, *receipt ? &**receipt : nullptr);
    ++out.units;
    if (!*receipt) continue;
    out.rejected += (*receipt)->rejection ? 1 : 0;
    const auto summary = summary_of(store, **receipt);
    if (!summary) return tl::unexpected(summary.error());
    if (!*summary) continue;
    for (const auto& j : (*summary)->journeys) writer.journey(j);
    for (const auto& f : (*summary)->failures) writer.failure(f);
  }
  if (out.open > 0 && !partial) {
    return failure(Exit::incomplete, {.field = "manifest",
                                      .found = fmt::format("{} of {} units open", out.open, m.units.size()),
                                      .expected = "a receipt of each",
                                      .advice = "'versine batch run --missing' does them; --partial goes without"});
  }
  writer.about(m, out.open == 0);
  out.journeys = static_cast<std::size_t>(writer.journey_id_);
  return out;
}
}  // namespace

Outcome<Merged> merge(const Store& store, const Manifest& m, const fs::path& out, bool partial,
                      const fs::path& scratch) {
  // SQLite writes here and there, which a network file system does slowly: built on local scratch, copied in one go.
  std::error_code code;
  const fs::path draft = scratch / fmt::format("versine-catalogue-{}.sqlite", process_id());
  const fs::path beside = out.parent_path() / fmt::format(".{}.new-{}", out.filename().string(), process_id());
  fs::remove(draft, code);
  const auto trouble = [&](const fs::path& path, std::string found) {
    fs::remove(draft, code), fs::remove(beside, code);
    return failure(Exit::again, {.file = path.string(),
                                 .found = std::move(found),
                                 .expected = "a place with free space that can be written",
                                 .advice = "free some space, or name another place (--out, VERSINE_SCRATCH)"});
  };
  Outcome<Merged> merged = Merged{};
  try {
    Writer writer(draft);
    merged = fill(writer, store, m, partial);
    if (merged) {
      writer.close();
      merged->passes = writer.passes, merged->failures = writer.failures;
    }
  } catch (const SqliteError& e) {
    return trouble(draft, e.what());
  }
  if (merged) {
    fs::copy_file(draft, beside, fs::copy_options::overwrite_existing, code);
    if (code || !flush_one(beside)) return trouble(beside, code ? code.message() : "that it cannot be flushed");
    fs::rename(beside, out, code);
    if (code) return trouble(out, code.message());
  }
  fs::remove(draft, code);
  return merged;
}

}  // namespace versine::batch
