// SPDX-License-Identifier: Apache-2.0
#include "versine/app/batch.hpp"

#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "command.hpp"
#include "terminal.hpp"
#include "versine/batch/catalogue.hpp"
#include "versine/batch/housekeeping.hpp"
#include "versine/batch/processes.hpp"
#include "versine/core/calendar.hpp"

namespace versine::cli {

namespace {
using batch::Exit;

/// BatchOptions of all verbs; each declares those that it has.
struct BatchOptions {
  std::string store, manifest, inputs, config, out, catalogue, track;
  std::optional<int> shard, shards;
  int threads = 0;
  bool missing = false, strict = false, partial = false, json = false, quiet = false;
  double older = 3600.0, at = 0.0, smallest_probability = 0.0;
  std::optional<double> from, to;
};

std::optional<std::string> environment(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (const char* value = std::getenv(name); value != nullptr && *value != '\0') return value;
  }
  return std::nullopt;
}

/// A variable that is there and is no number: a shard done twice, or never, if it went unnoticed.
struct BadVariable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::optional<int> number_in(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const auto text = environment({name});
    if (!text) continue;
    int value = 0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
    if (error != std::errc() || end != text->data() + text->size()) {
      throw BadVariable(std::string(name) + ": found '" + *text + "', expected a whole number");
    }
    return value;
  }
  return std::nullopt;
}

int exit_code(Exit exit) {
  return static_cast<int>(exit);
}

int told(const batch::Failure& failure) {
  std::fprintf(stderr, "versine: %s\n", failure.error.message().c_str());
  return exit_code(failure.exit);
}

batch::Outcome<batch::Store> open_store(const BatchOptions& o, bool make) {
  const std::string folder = o.store.empty() ? environment({"VERSINE_STORE"}).value_or("") : o.store;
  if (folder.empty()) {
    return batch::failure(Exit::usage, {.field = "--store",
                                        .found = "none",
                                        .expected = "the folder of the results",
                                        .advice = "name it with --store or VERSINE_STORE"});
  }
  return batch::Store::open(folder, make);
}

struct Opened {
  batch::Store store;
  batch::Manifest manifest;
};
batch::Outcome<Opened> open_manifest(const BatchOptions& o) {
  auto store = open_store(o, false);
  if (!store) return tl::unexpected(store.error());
  auto m =
      batch::read_manifest(*store, o.manifest.empty() ? environment({"VERSINE_MANIFEST"}).value_or("") : o.manifest);
  if (!m) return tl::unexpected(m.error());
  return Opened{std::move(*store), std::move(*m)};
}

/// The shard from the command line, else from Versine's variables, else from the engine that started this process.
batch::Selection selection(const BatchOptions& o, const batch::Manifest& m) {
  batch::Selection s{{}, o.missing};
  auto index =
      o.shard
          ? o.shard
          : number_in({"VERSINE_SHARD", "SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "AWS_BATCH_JOB_ARRAY_INDEX"});
  if (!index) {
    if (const auto sequence = number_in({"PARALLEL_SEQ"})) index = *sequence - 1;
  }
  const auto count = o.shards ? o.shards : number_in({"VERSINE_SHARDS"});
  if (index) s.shard = batch::Shard{*index, count.value_or(m.shards)};
  return s;
}

/// 1 for the first.
int attempt() {
  if (const auto n = number_in({"VERSINE_ATTEMPT"})) return *n;
  if (const auto n = number_in({"SLURM_RESTART_COUNT"})) return *n + 1;
  return number_in({"AWS_BATCH_JOB_ATTEMPT"}).value_or(1);
}

int plan(const BatchOptions& o) {
  auto store = open_store(o, true);
  if (!store) return told(store.error());
  TerminalProgress progress(o.quiet);
  auto job = app::batch_job(o.config);
  if (!job) return told(job.error());
  const auto inputs = app::batch_inputs(o.inputs, progress);
  if (!inputs) return told(inputs.error());
  const int shards = o.shards ? *o.shards : number_in({"VERSINE_SHARDS"}).value_or(1);
  auto m = batch::make_manifest(app::batch_engine(), "georef", std::move(*job), *inputs, std::max(1, shards));
  if (const auto written = batch::write_manifest(*store, m); !written) return told(written.error());
  if (!o.quiet) {
    std::fprintf(stderr, "%zu files, %zu units, %d shards\n", inputs->size(), m.units.size(), m.shards);
  }
  std::printf("%s\n", m.id.c_str());
  return exit_code(Exit::done);
}

Exit work(const Opened& opened, const std::vector<std::size_t>& units, const batch::WorkQueue& queue,
          const TerminalProgress& progress) {
  const auto stage = app::GeorefStage::prepare(opened.manifest);
  if (!stage) return static_cast<Exit>(told(stage.error()));
  const auto next = [&]() -> std::optional<std::size_t> {
    const auto i = queue.next();
    return i ? std::optional(units[*i]) : std::nullopt;
  };
  const auto note = [&](const batch::Done& done) {
    const batch::Unit& unit = opened.manifest.units[done.unit];
    batch::write_log(opened.store, opened.manifest.id, unit.unit, to_string(done.state), done.seconds);
    if (done.failure) told(*done.failure);
    queue.done();
  };
  return batch::run_units(
      opened.store, opened.manifest, *stage, next, [&] { return progress.cancelled(); }, note);
}

/// Rejected ones among the units that this call was responsible for.
bool any_rejected(const Opened& opened, const batch::Selection& selection) {
  for (const auto& unit : opened.manifest.units) {
    if (selection.shard && !selection.missing && unit.shard != selection.shard->index) continue;
    const auto receipt = batch::find_receipt(opened.store, unit.unit);
    if (receipt && *receipt && (*receipt)->rejection) return true;
  }
  return false;
}

int run(const BatchOptions& o) {
#ifdef SIGXFSZ
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit comes out as a failed write: 75, not a crash
#endif
  const auto opened = open_manifest(o);
  if (!opened) return exit_code(batch::after_attempts(static_cast<Exit>(told(opened.error())), attempt()));
  const auto chosen = selection(o, opened->manifest);
  const auto units = batch::select_units(opened->store, opened->manifest, chosen);
  if (!units) return told(units.error());
  TerminalProgress progress(o.quiet);
  const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int processes = std::max(
      1, std::min(o.threads > 0 ? o.threads : cores, static_cast<int>(std::min<std::size_t>(units->size(), 1024))));
  Exit exit = Exit::done;
  if (!units->empty()) {
    exit = batch::run_processes(
        processes, units->size(), [&](const batch::WorkQueue& queue) { return work(*opened, *units, queue, progress); },
        [&](std::size_t done) {
          progress.report("units", static_cast<double>(done) / static_cast<double>(units->size()));
          return !progress.cancelled();
        });
  }
  if (progress.cancelled()) exit = batch::graver(exit, Exit::again);
  if (exit == Exit::done && o.strict && any_rejected(*opened, chosen)) exit = Exit::rejected;
  return exit_code(batch::after_attempts(exit, attempt()));
}

int status(const BatchOptions& o) {
  const auto opened = open_manifest(o);
  if (!opened) return told(opened.error());
  const auto s = batch::status(opened->store, opened->manifest);
  if (!s) return told(s.error());
  if (o.json) {
    nlohmann::ordered_json j{{"manifest", opened->manifest.id},
                             {"units", opened->manifest.units.size()},
                             {"done", s->done},
                             {"rejected", s->rejected},
                             {"open", s->open},
                             {"damaged", s->damaged},
                             {"units_per_s", s->units_per_second},
                             {"seconds_left", s->seconds_left}};
    for (const auto& shard : s->shards) {
      j["shards"].push_back({{"done", shard.done}, {"rejected", shard.rejected}, {"open", shard.open}});
    }
    std::printf("%s\n", j.dump(1).c_str());
  } else {
    std::printf("%zu units: %zu done, %zu rejected, %zu open", opened->manifest.units.size(), s->done, s->rejected,
                s->open);
    if (s->damaged > 0) std::printf(" (%zu of them with a damaged receipt)", s->damaged);
    if (s->units_per_second > 0.0) std::printf("; %.2f units/s", s->units_per_second);
    if (s->open > 0 && s->seconds_left > 0.0) std::printf(", %.0f s left", s->seconds_left);
    std::printf("\n");
    for (std::size_t i = 0; i < s->shards.size() && s->shards.size() > 1; ++i) {
      const auto& shard = s->shards[i];
      std::printf("shard %zu: %zu done, %zu rejected, %zu open\n", i, shard.done, shard.rejected, shard.open);
    }
  }
  return exit_code(s->exit());
}

int merge(const BatchOptions& o) {
  const auto opened = open_manifest(o);
  if (!opened) return told(opened.error());
  std::error_code code;
  const auto scratch = environment({"VERSINE_SCRATCH"});
  const std::filesystem::path folder =
      scratch ? std::filesystem::path(*scratch) : std::filesystem::temp_directory_path(code);
  const auto merged =
      batch::merge(opened->store, opened->manifest, std::filesystem::absolute(o.out), o.partial, folder);
  if (!merged) return exit_code(batch::after_attempts(static_cast<Exit>(told(merged.error())), attempt()));
  if (!o.quiet) {
    std::printf("%zu units (%zu rejected, %zu open), %zu journeys, %zu passes, %zu failures: %s\n", merged->units,
                merged->rejected, merged->open, merged->journeys, merged->passes, merged->failures, o.out.c_str());
  }
  return exit_code(Exit::done);
}

int verify(const BatchOptions& o) {
  const auto store = open_store(o, false);
  if (!store) return told(store.error());
  const auto v = batch::verify(*store);
  if (!v) return told(v.error());
  for (const auto& e : v->withdrawn) std::fprintf(stderr, "versine: %s\n", e.message().c_str());
  if (!o.quiet) std::printf("%zu receipts, %zu objects, %zu withdrawn\n", v->receipts, v->objects, v->withdrawn.size());
  return exit_code(v->withdrawn.empty() ? Exit::done : Exit::incomplete);
}

int gc(const BatchOptions& o) {
  const auto store = open_store(o, false);
  if (!store) return told(store.error());
  const auto c = batch::collect_garbage(*store, o.older);
  if (!c) return told(c.error());
  if (!o.quiet)
    std::printf("removed %zu temporary files, %zu objects, %zu bytes\n", c->tmp, c->objects,
                static_cast<std::size_t>(c->bytes));
  return exit_code(Exit::done);
}

int passes(const BatchOptions& o) {
  batch::PassQuery query{o.track, o.at, {}, {}, o.smallest_probability};
  if (o.from) query.from = Time::from_seconds(*o.from);
  if (o.to) query.to = Time::from_seconds(*o.to);
  const auto found = batch::find_passes(o.catalogue, query);
  if (!found) return told(found.error());
  if (o.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const auto& p : *found) {
      list.push_back({{"time_ns", p.here.time.ns},
                      {"time", to_text(p.here.time, p.scale)},
                      {"speed_mps", p.here.speed},
                      {"sigma_m", p.here.sigma},
                      {"probability", p.probability},
                      {"file", p.file},
                      {"recording", p.recording},
                      {"journey", p.journey},
                      {"unit", p.unit}});
    }
    std::printf("%s\n", list.dump(1).c_str());
    return exit_code(Exit::done);
  }
  std::printf("time,time_s,speed_kmh,sigma_m,probability,file,recording,journey\n");
  for (const auto& p : *found) {
    std::printf("%s,%s,%.2f,%.3f,%.4f,%s,%s,%d\n", to_text(p.here.time, p.scale).c_str(),
                seconds_text(p.here.time).c_str(), 3.6 * p.here.speed, p.here.sigma, p.probability, p.file.c_str(),
                p.recording.c_str(), p.journey);
  }
  return exit_code(Exit::done);
}

using Verb = int (*)(const BatchOptions&);

CLI::App* add_verb(CLI::App& batch, const std::shared_ptr<BatchOptions>& o, int& exit, const char* name,
                   const char* help, Verb verb) {
  auto* c = batch.add_subcommand(name, help);
  c->add_flag("--quiet", o->quiet, "Print nothing but errors");
  c->callback([o, &exit, verb] {
    try {
      exit = verb(*o);
    } catch (const BadVariable& e) {
      std::fprintf(stderr, "versine: %s\n", e.what());
      exit = exit_code(Exit::usage);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "versine: internal error: %s\n", e.what());
      exit = exit_code(Exit::failed);
    }
  });
  return c;
}
}  // namespace

void add_batch(CLI::App& app, int& exit) {
  auto* batch = app.add_subcommand("batch", "Georeference a fleet: work units that any engine can run and repeat");
  batch->require_subcommand(1);
  const auto o = std::make_shared<BatchOptions>();
  const auto store = [o](CLI::App* c) { c->add_option("--store", o->store, "Folder of the results (VERSINE_STORE)"); };
  const auto manifest = [o, store](CLI::App* c) {
    store(c);
    c->add_option("--manifest", o->manifest, "Its id or the beginning of it (VERSINE_MANIFEST); none: the only one");
  };
  auto* c = add_verb(*batch, o, exit, "plan", "Write a manifest of the work and print its id", plan);
  store(c);
  c->add_option("--inputs", o->inputs, "Folder of recordings, or a text file with a path a line")->required();
  c->add_option("--config", o->config, "Georef job (TOML); its recordings are not used")->required();
  c->add_option("--shards", o->shards, "Parts for as many workers (VERSINE_SHARDS)")->check(CLI::Range(1, 1000000));

  c = add_verb(*batch, o, exit, "run", "Do the units of a shard, or all", run);
  manifest(c);
  c->add_option("--shard", o->shard, "From 0 (VERSINE_SHARD, or the engine's array index)");
  c->add_option("--shards", o->shards, "How many (VERSINE_SHARDS)")->check(CLI::Range(1, 1000000));
  c->add_flag("--missing", o->missing, "Sweep: units without receipt, split by their names");
  c->add_option("--threads", o->threads, "Worker processes; 0: one a core")->check(CLI::Range(0, 1024));
  c->add_flag("--strict", o->strict, "Exit with 3 when units were rejected");

  c = add_verb(*batch, o, exit, "status", "Done, rejected, open; rate and remaining time", status);
  manifest(c);
  c->add_flag("--json", o->json, "Machine-readable");

  c = add_verb(*batch, o, exit, "merge", "Write the catalogue of all journeys (SQLite)", merge);
  manifest(c);
  c->add_option("--out", o->out, "Catalogue")->required();
  c->add_flag("--partial", o->partial, "Go without the units that are open");

  c = add_verb(*batch, o, exit, "verify", "Re-hash the results and withdraw bad receipts", verify);
  store(c);
  c = add_verb(*batch, o, exit, "gc", "Remove what dead workers left", gc);
  store(c);
  c->add_option("--older", o->older, "Only what was not touched for so many seconds")->check(CLI::NonNegativeNumber);

  c = add_verb(*batch, o, exit, "passes", "Which journeys passed a metre of a track, when and how fast", passes);
  c->add_option("--catalogue", o->catalogue, "File that 'merge' wrote")->required();
  c->add_option("--track", o->track, "Track of the map")->required();
  c->add_option("--at", o->at, "Metres from the track's beginning")->required();
  c->add_option("--from", o->from, "Not before, s of the recordings' time");
  c->add_option("--to", o->to, "Not after, s of the recordings' time");
  c->add_option("--min-probability", o->smallest_probability, "Of having been on this track")
      ->check(CLI::Range(0.0, 1.0));
  c->add_flag("--json", o->json, "Machine-readable");
}

}  // namespace versine::cli
