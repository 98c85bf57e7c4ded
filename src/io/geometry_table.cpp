// SPDX-License-Identifier: Apache-2.0
#include "versine/io/geometry_table.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <cstring>
#include <optional>
#include <thread>

#include "versine/core/numbers.hpp"

namespace versine::io {

namespace ipc = boost::interprocess;

struct GeometryTable::Mapping {
  ipc::mapped_region region;
  [[nodiscard]] const char* begin() const { return static_cast<const char*>(region.get_address()); }
  [[nodiscard]] const char* end() const { return begin() + region.get_size(); }
};

namespace {

Error unreadable(const std::filesystem::path& path, std::string found) {
  return {.file = path.string(),
          .found = std::move(found),
          .expected = "the table of track geometry that a Versine job wrote",
          .advice = "run the job again; the file was changed, or cut short while it was copied"};
}

/// What one thread makes of its lines.
struct Part {
  std::size_t first = 0, last = 0;  ///< lines
  std::optional<std::pair<std::size_t, std::string>> fault;
};

}  // namespace

Expected<GeometryTable> GeometryTable::open(const std::filesystem::path& path) {
  GeometryTable table;
  table.name_ = path.string();
  try {
    const ipc::file_mapping file(path.string().c_str(), ipc::read_only);
    auto mapping = std::make_shared<Mapping>();
    mapping->region = ipc::mapped_region(file, ipc::read_only);
    table.mapping_ = std::move(mapping);
  } catch (const ipc::interprocess_exception&) {
    return tl::unexpected(unreadable(path, "that it is empty or cannot be read"));
  }
  const char *begin = table.mapping_->begin(), *end = table.mapping_->end();
  const char* p = static_cast<const char*>(std::memchr(begin, '\n', static_cast<std::size_t>(end - begin)));
  if (p == nullptr || !std::string_view(begin, p).starts_with("distance_m,mileage_m,")) {
    return tl::unexpected(unreadable(path, "a first line that does not begin with distance_m,mileage_m"));
  }
  for (const char* a = begin; a < p;) {
    const char* b = std::find(a, p, ',');
    table.columns_.emplace_back(a, b);
    a = b + 1;
  }
  if (end[-1] != '\n') return tl::unexpected(unreadable(path, "a last line without its end"));
  for (++p; p < end;) {
    table.lines_.push_back(static_cast<std::size_t>(p - begin));
    p = static_cast<const char*>(std::memchr(p, '\n', static_cast<std::size_t>(end - p))) + 1;
  }
  table.lines_.push_back(static_cast<std::size_t>(end - begin));
  return table;
}

bool GeometryTable::has(const std::string& column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

Expected<std::vector<std::vector<double>>> GeometryTable::read(std::span<const std::string> wanted) const {
  std::vector<std::vector<double>> out(wanted.size(), std::vector<double>(rows(), nan));
  // Places of the wanted columns in the order of the file, so that a line is passed once.
  std::vector<std::pair<std::size_t, std::size_t>> plan;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    plan.emplace_back(
        static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), wanted[k]) - columns_.begin()), k);
  }
  std::sort(plan.begin(), plan.end());
  const char* begin = mapping_->begin();
  const auto parse = [&](Part& part) {
    for (std::size_t i = part.first; i < part.last; ++i) {
      const char *p = begin + lines_[i], *end = begin + lines_[i + 1] - 1;
      std::size_t at = 0;
      for (const auto& [column, k] : plan) {
        for (; at < column; ++at) {
          p = static_cast<const char*>(std::memchr(p, ',', static_cast<std::size_t>(end - p)));
          if (p == nullptr) return void(part.fault = {i, "fewer fields than the header has"});
          ++p;
        }
        if (p == end || *p == ',') continue;
        const auto [rest, code] = fast_float::from_chars(p, end, out[k][i]);
        if (code != std::errc() || (rest != end && *rest != ',')) {
          return void(part.fault = {i, fmt::format("'{}' is not a number", std::string(p, std::find(p, end, ',')))});
        }
        p = rest;
      }
    }
  };
  const std::size_t count =
      std::clamp<std::size_t>(std::min<std::size_t>(std::thread::hardware_concurrency(), rows() / 4096), 1, 16);
  std::vector<Part> parts(count);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < count; ++t) {
    parts[t].first = rows() * t / count;
    parts[t].last = rows() * (t + 1) / count;
    if (t + 1 < count) threads.emplace_back([&parse, &part = parts[t]] { parse(part); });
  }
  parse(parts.back());
  for (auto& thread : threads) thread.join();
  for (const Part& part : parts) {
    if (!part.fault) continue;
    Error error = unreadable(name_, part.fault->second);
    error.line = part.fault->first + 2;
    return tl::unexpected(std::move(error));
  }
  return out;
}

}  // namespace versine::io
