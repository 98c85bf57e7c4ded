// SPDX-License-Identifier: Apache-2.0
#include "versine/io/run_json.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "text_output.hpp"
#include "versine/core/calendar.hpp"
#include "versine/io/open_error.hpp"
#include "versine/io/sha256.hpp"

namespace versine::io {

namespace {
using Json = nlohmann::ordered_json;

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

const char* name_of(TimeScale scale) {
  switch (scale) {
    case TimeScale::gps:
      return "GPS, s since 1980-01-06";
    case TimeScale::utc:
      return "UTC, s since 1970-01-01 without leap seconds";
    case TimeScale::recorder:
      return "recorder's own clock, s";
  }
  return "";
}

// JSON has no NaN: what is not known is null.
Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

// Text of the caller's own making; what is no JSON is kept as text rather than lost.
Json parsed(const std::string& text) {
  Json value = Json::parse(text.empty() ? "{}" : text, nullptr, false);
  return value.is_discarded() ? Json(text) : value;
}

Json record_json(const RunRecord& record, TimeScale scale) {
  Json findings = Json::array(), rejections = Json::array();
  for (const Finding& f : record.findings) {
    findings.push_back({{"sensor", f.sensor},
                        {"kind", f.kind},
                        {"from_s", seconds_text(f.from)},
                        {"to_s", seconds_text(f.to)},
                        {"from", to_text(f.from, scale)},
                        {"count", f.count},
                        {"action", to_string(f.action)},
                        {"detail", f.detail}});
  }
  for (const Rejection& r : record.rejections) {
    rejections.push_back({{"sensor", r.sensor},
                          {"time_s", seconds_text(r.time)},
                          {"reason", r.reason},
                          {"normalized", number(r.normalized)},
                          {"threshold", number(r.threshold)}});
  }
  return {{"warnings", record.warnings}, {"findings", findings}, {"rejections", rejections}};
}
}  // namespace

Expected<RunInput> describe_input(std::string role, std::string written, const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.string().c_str(), "rb"));
  if (!file) return tl::unexpected(open_error(path));
  Sha256 hash;
  RunInput input{.role = std::move(role), .written = std::move(written), .path = path};
  std::vector<char> block(std::size_t{1} << 20);
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get())) {
    hash.add(block.data(), n);
    input.bytes += n;
  }
  if (std::ferror(file.get()) != 0) return tl::unexpected(open_error(path));
  input.sha256 = hash.hex();
  return input;
}

std::string run_json(const Run& run) {
  Json inputs = Json::array(), timings = Json::object();
  for (const RunInput& input : run.inputs) {
    inputs.push_back({{"role", input.role}, {"file", input.written}, {"bytes", input.bytes}, {"sha256", input.sha256}});
  }
  for (const auto& [stage, seconds] : run.timings_s) timings[stage] = number(seconds);
  Json root{{"format", "versine run 1"},
            {"command", run.command},
            {"version", run.version},
            {"started_utc", run.started_utc},
            {"time_scale", name_of(run.time_scale)},
            {"inputs", inputs},
            {"libraries", run.libraries},
            {"settings", parsed(run.settings_json)},
            {"timings_s", timings},
            {"results", parsed(run.results_json)}};
  root.update(record_json(run.record, run.time_scale));
  return root.dump(2, ' ', false, Json::error_handler_t::replace);
}

Expected<void> write_run_json(const std::filesystem::path& path, const Run& run) {
  TextOutput out(path);
  out.text(run_json(run));
  out.end_line();
  return out.close();
}

}  // namespace versine::io
