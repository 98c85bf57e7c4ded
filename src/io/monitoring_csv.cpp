// SPDX-License-Identifier: Apache-2.0
#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>

#include "monitoring_source.hpp"
#include "versine/core/calendar.hpp"
#include "versine/io/table_reader.hpp"

namespace versine::io {

namespace {
class CsvSource final : public MonitoringReader::Source {
 public:
  CsvSource(MonitoringFile file, TableReader table) : Source(std::move(file)), table_(std::move(table)) {}

  Expected<void> bind() {
    for (const auto& name : file_.channels) {
      const auto slot = column(name);
      if (!slot) return fail(missing(name));
      channels_.push_back(*slot);
    }
    if (file_.times.empty()) return {};
    times_ = column(file_.times);
    if (!times_) return fail(missing(file_.times));
    return {};
  }

  Expected<bool> read(georef::SampleBlock& block) override {
    block.first = at_;
    block.times.clear();
    block.channels.resize(channels_.size());
    for (auto& c : block.channels) c.clear();
    std::size_t count = 0;
    for (; count < block_size && table_.next(); ++count, ++at_) {
      for (std::size_t c = 0; c < channels_.size(); ++c) {
        const auto text = table_.text(channels_[c]);
        double value = 0.0;
        const auto end = fast_float::from_chars(text.data(), text.data() + text.size(), value);
        if (end.ec != std::errc()) {
          return fail(table_.complaint(channels_[c], fmt::format("'{}'", text), "a number", "mend or remove the row"));
        }
        block.channels[c].push_back(static_cast<float>(value * file_.scale));
      }
      if (!times_) continue;
      auto text = table_.text(*times_);
      const auto ns = parse_decimal(text, 9);
      if (!ns) return fail(table_.complaint(*times_, fmt::format("'{}'", text), "seconds", "mend or remove the row"));
      block.times.push_back({*ns});
    }
    if (table_.error()) return fail(*table_.error());
    return count > 0;
  }

 private:
  std::optional<TableReader::Slot> column(const std::string& name) {
    const auto& names = table_.written();
    const auto it = std::find(names.begin(), names.end(), name);
    if (it == names.end()) return std::nullopt;
    return table_.text_column(static_cast<std::size_t>(it - names.begin()));
  }
  [[nodiscard]] Error missing(const std::string& name) const {
    return trouble(name, fmt::format("columns {}", fmt::join(table_.written(), ", ")), "a column of that name");
  }

  TableReader table_;
  std::vector<TableReader::Slot> channels_;
  std::optional<TableReader::Slot> times_;
  std::uint64_t at_ = 0;
};
}  // namespace

Expected<std::unique_ptr<MonitoringReader::Source>> open_monitoring_csv(const MonitoringFile& file) {
  auto lines = LineReader::open(file.path);
  if (!lines) return tl::unexpected(lines.error());
  TableFile description;
  description.path = file.path;
  auto table = TableReader::open(std::move(*lines), description);
  if (!table) return tl::unexpected(table.error());
  auto source = std::make_unique<CsvSource>(file, std::move(*table));
  if (const auto bound = source->bind(); !bound) return tl::unexpected(bound.error());
  return std::unique_ptr<MonitoringReader::Source>(std::move(source));
}

}  // namespace versine::io
