// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "versine/batch/outcome.hpp"
#include "versine/batch/store.hpp"

namespace versine::batch {

/// A file that a unit reads.
struct Input {
  std::string uri;  ///< absolute path
  std::string sha256;
  std::uintmax_t bytes = 0;
};

/// What is done at once, or not at all: one stage on its inputs.
struct Unit {
  std::string unit;  ///< sha256(engine | config | stage | digests of the inputs)
  std::string stage;
  std::vector<Input> inputs;
  std::uintmax_t weight = 0;  ///< bytes of its inputs
  int shard = 0;
};

/// What a job says, as the manifest keeps it: a worker needs the manifest, the inputs and the map, not the job's file.
struct Job {
  std::string path;    ///< of the job's file when the manifest was written; relative paths in it start there
  std::string text;    ///< the file
  std::string config;  ///< sha256 of the effective settings and of what they refer to (the map)
};

struct Manifest {
  std::string id;  ///< sha256 of manifest.json
  std::string engine, stage;
  Job job;
  int shards = 1;
  std::vector<Unit> units;  ///< sorted by unit
};

[[nodiscard]] std::string unit_name(const std::string& engine, const std::string& config, const std::string& stage,
                                    const std::vector<Input>& inputs);

/// Units of the inputs that belong together, and their shards: the longest first onto the least loaded. Inputs of equal
/// content are one unit, that of the first of them.
[[nodiscard]] Manifest make_manifest(std::string engine, std::string stage, Job job,
                                     const std::vector<std::vector<Input>>& inputs, int shards);
/// Writes manifests/<id>/{manifest.json, units.jsonl}; the same plan again is the same manifest.
[[nodiscard]] Outcome<void> write_manifest(const Store& store, Manifest& manifest);
/// `id` may be a unique beginning; empty: the only manifest of the store. Fails (65) when the files are not what they
/// were written as.
[[nodiscard]] Outcome<Manifest> read_manifest(const Store& store, const std::string& id);

}  // namespace versine::batch
