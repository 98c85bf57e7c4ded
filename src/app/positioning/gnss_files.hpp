// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/app/gnss.hpp"
#include "versine/core/process.hpp"
#include "versine/gnss/rinex_scan.hpp"

/// The files of a GNSS job, whatever they are, as plain RINEX in a folder that RTKLIB reads.
namespace versine::app::gnss_files {

/// A folder of our own that goes away with us.
struct Workspace {
  std::filesystem::path folder;
  Workspace();
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
};

struct File {
  std::filesystem::path path;
  gnss::RinexScan scan;
};
/// Everything that RTKLIB reads, as plain RINEX.
struct Files {
  std::vector<File> rover, base, navigation;
};

/// From the first epoch of all files to the last.
struct Span {
  Time first, last;
};
Span span_of(const std::vector<File>& files);

/// Reads, expands, converts and scans every file. Fails on a file that is none of the formats or of another role.
Expected<Files> prepare(const GnssProcessing& g, const Workspace& workspace, Progress& progress);

/// Is everything there, of the same time and day?
Expected<void> check(const GnssProcessing& g, const Files& files);

/// The first of the programs that is on PATH.
Expected<std::filesystem::path> need_program(std::initializer_list<std::string_view> names, const std::string& advice);

/// What a program that failed on `input` has said.
Error failed(const std::filesystem::path& program, const InputPath& input, const ProcessResult& r);

}  // namespace versine::app::gnss_files
