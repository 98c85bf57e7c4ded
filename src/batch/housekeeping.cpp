// SPDX-License-Identifier: Apache-2.0
#include "versine/batch/housekeeping.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "versine/batch/receipt.hpp"
#include "versine/core/file_system.hpp"
#include "versine/io/run_json.hpp"

namespace versine::batch {

namespace fs = std::filesystem;

namespace {
double now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Regular files two levels below a folder: objects/ab/..., receipts/ab/...
std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code code;
  for (const auto& part : fs::directory_iterator(folder, code)) {
    for (const auto& entry : fs::directory_iterator(part.path(), code)) out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

struct Logged {
  double first = 0.0, last = 0.0, weight = 0.0;
  std::size_t units = 0;
};

/// What the log tells of the rate since the last pause of more than ten minutes.
Logged read_log(const Store& store, const Manifest& m) {
  std::map<std::string, double> weights;
  for (const Unit& u : m.units) weights[u.unit] = static_cast<double>(u.weight);
  Logged out;
  std::ifstream stream(store.log(m.id));
  for (std::string line; std::getline(stream, line);) {
    const auto j = nlohmann::json::parse(line, nullptr, false);
    if (!j.is_object() || !j.contains("t") || !j.contains("unit") || !j.contains("seconds")) continue;
    const double t = j["t"].get<double>(), begun = t - j["seconds"].get<double>();
    if (out.units == 0 || begun - out.last > 600.0) out = {begun, t, 0.0, 0};
    out.last = std::max(out.last, t);
    out.first = std::min(out.first, begun);
    out.weight += weights[j["unit"].get<std::string>()];
    ++out.units;
  }
  return out;
}
}  // namespace

Outcome<Status> status(const Store& store, const Manifest& m) {
  Status s;
  s.shards.resize(static_cast<std::size_t>(m.shards));
  double open_weight = 0.0;
  for (const Unit& u : m.units) {
    ShardStatus& shard = s.shards[static_cast<std::size_t>(u.shard)];
    const auto receipt = find_receipt(store, u.unit);
    if (!receipt) ++s.damaged;
    if (!receipt || !*receipt) {
      ++shard.open, ++s.open;
      open_weight += static_cast<double>(u.weight);
    } else if ((*receipt)->rejection) {
      ++shard.rejected, ++s.rejected;
    } else {
      ++shard.done, ++s.done;
    }
  }
  const Logged log = read_log(store, m);
  const double spent = log.last - log.first;
  if (spent > 0.0) {
    s.units_per_second = static_cast<double>(log.units) / spent;
    if (log.weight > 0.0) s.seconds_left = open_weight / log.weight * spent;
  }
  return s;
}

void write_log(const Store& store, const std::string& manifest, const std::string& unit, const std::string& state,
               double seconds) {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  const std::string line =
      nlohmann::ordered_json{
          {"t", std::round(now() * 1000.0) / 1000.0},         {"unit", unit}, {"state", state},
          {"seconds", std::round(seconds * 1000.0) / 1000.0}, {"host", host}, {"process", process_id()}}
          .dump() +
      "\n";
  // One write of one line: lines of several workers do not mix. Nothing depends on it.
  const int file = ::open(store.log(manifest).c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) return;
  [[maybe_unused]] const auto written = ::write(file, line.data(), line.size());
  ::close(file);
}

Outcome<Verification> verify(const Store& store) {
  Verification v;
  std::error_code code;
  std::set<std::string> good;
  for (const auto& path : files_below(store.objects())) {
    ++v.objects;
    const auto input = io::describe_input("object", path.filename().string(), path);
    if (!input) return failure(Exit::again, input.error());
    if (input->sha256 == path.filename().string()) {
      good.insert(input->sha256);
      continue;
    }
    v.withdrawn.push_back({.file = path.string(), .found = "an object of another SHA-256", .advice = "removed"});
    fs::remove(path, code);
  }
  for (const auto& path : files_below(store.receipts())) {
    ++v.receipts;
    const std::string unit = path.stem().string();
    const auto receipt = find_receipt(store, unit);
    std::string found;
    if (!receipt) {
      found = receipt.error().error.found;
    } else if (*receipt) {
      for (const Output& o : (*receipt)->outputs) {
        if (!good.contains(o.sha256)) found = fmt::format("its {} missing or damaged", o.name);
      }
    }
    if (found.empty()) continue;
    v.withdrawn.push_back({.file = path.string(), .found = found, .advice = "withdrawn; 'run --missing' repeats it"});
    fs::remove(path, code);
  }
  return v;
}

Outcome<Collected> collect_garbage(const Store& store, double older) {
  Collected c;
  std::error_code code;
  const auto limit = fs::file_time_type::clock::now() -
                     std::chrono::duration_cast<fs::file_time_type::duration>(std::chrono::duration<double>(older));
  const auto remove_old = [&](const fs::path& path, std::size_t& count) {
    const auto size = fs::file_size(path, code);
    if (fs::last_write_time(path, code) > limit || code) return;
    if (fs::remove(path, code)) ++count, c.bytes += size;
  };
  // Objects first seen, then receipts: what is linked meanwhile is newer than any sensible `older`.
  const auto objects = files_below(store.objects());
  std::set<std::string> named;
  for (const auto& path : files_below(store.receipts())) {
    const auto receipt = find_receipt(store, path.stem().string());
    if (!receipt) return tl::unexpected(receipt.error());
    if (*receipt) {
      for (const Output& o : (*receipt)->outputs) named.insert(o.sha256);
    }
  }
  for (const auto& path : objects) {
    if (!named.contains(path.filename().string())) remove_old(path, c.objects);
  }
  for (const auto& entry : fs::directory_iterator(store.tmp(), code)) remove_old(entry.path(), c.tmp);
  return c;
}

}  // namespace versine::batch
