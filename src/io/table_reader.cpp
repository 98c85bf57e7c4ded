// SPDX-License-Identifier: Apache-2.0
#include "versine/io/table_reader.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "field_text.hpp"
#include "table_fields.hpp"
#include "versine/core/calendar.hpp"
#include "versine/core/numbers.hpp"
#include "versine/core/text.hpp"

namespace versine::io {

namespace {
bool blank(char c) {
  return c == ' ' || c == '\t';
}

const char* skip_blanks(const char* p, const char* end) {
  while (p != end && blank(*p)) ++p;
  return p;
}

// What stands for a missing number in files of others.
bool stands_for_nothing(std::string_view field) {
  std::string low(field);
  std::transform(low.begin(), low.end(), low.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (!low.empty() && (low.front() == '-' || low.front() == '+')) low.erase(0, 1);
  return low.empty() || low == "nan" || low == "inf" || low == "infinity" || low == "null" || low == "na" ||
         low == "n/a";
}
}  // namespace

std::vector<std::string> split_fields(std::string_view line, char delimiter) {
  std::vector<std::string> fields;
  const char* p = line.data();
  const char* const end = p + line.size();
  while (true) {
    if (delimiter == ' ' || delimiter != '\t') p = skip_blanks(p, end);
    if (p == end) break;
    std::string field;
    if (*p == '"') {
      for (++p; p != end && *p != '"'; ++p) field += *p;
      while (p != end && *p != delimiter && !(delimiter == ' ' && blank(*p))) ++p;
    } else {
      const char* const start = p;
      while (p != end && *p != delimiter && !(delimiter == ' ' && blank(*p))) ++p;
      field = trimmed({start, static_cast<std::size_t>(p - start)});
    }
    fields.push_back(std::move(field));
    if (p == end) break;
    ++p;
  }
  return fields;
}

bool TableReader::has(std::string_view base) const {
  return column_of(base).has_value();
}

std::optional<std::size_t> TableReader::column_of(std::string_view base) const {
  for (std::size_t i = 0; i < header_.size(); ++i) {
    if (header_[i].empty()) continue;
    const ColumnName name = split_column_name(header_[i]);
    if (name.base == base || header_[i] == base || header_[i] == std::string(base) + "_count") return i;
  }
  return std::nullopt;
}

TableReader::Slot TableReader::slot_for(std::size_t column, Kind kind, double factor, int digits, std::string unit) {
  if (plan_[column]) return *plan_[column];
  plan_[column] = slots_.size();
  slots_.push_back({.column = column,
                    .kind = kind,
                    .factor = factor,
                    .digits = digits,
                    .label = written_[column],
                    .unit = std::move(unit)});
  return slots_.size() - 1;
}

Expected<std::optional<TableReader::Slot>> TableReader::find(std::string_view base, Quantity quantity, double scale) {
  const auto column = column_of(base);
  if (!column) return std::optional<Slot>();
  const ColumnName name = split_column_name(header_[*column]);
  const bool counts = header_[*column].ends_with("_count") || header_[*column].ends_with("_counts");
  if (quantity == Quantity::none || counts) return slot_for(*column, Kind::number, scale, 0, "a number");
  if (name.unit == nullptr || name.unit->quantity != quantity || name.base != base) {
    return fail({.file = name.base.empty() ? this->name() : this->name(),
                 .line = header_line_,
                 .field = written_[*column],
                 .found = name.unit == nullptr ? "no unit" : fmt::format("the unit {}", name.unit->text),
                 .expected = fmt::format("one of {}", suffixes(quantity)),
                 .advice = fmt::format("name the unit in [columns]: {}{} = \"{}\"", base,
                                       std::string_view(suffixes(quantity)).substr(0, suffixes(quantity).find(',')),
                                       written_[*column])});
  }
  return slot_for(*column, Kind::number, name.unit->factor * scale, 0, fmt::format("a number in {}", name.unit->text));
}

Expected<TableReader::Slot> TableReader::need(std::string_view base, Quantity quantity, double scale) {
  const auto slot = find(base, quantity, scale);
  if (!slot) return tl::unexpected(slot.error());
  if (*slot) return **slot;
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < header_.size(); ++i) names.push_back(header_[i].empty() ? written_[i] : header_[i]);
  const std::string all = suffixes(quantity);
  const std::string wanted =
      quantity == Quantity::none ? std::string(base) : std::string(base) + all.substr(0, all.find(','));
  const std::string_view close = nearest(wanted, names);
  const auto at = std::find(names.begin(), names.end(), close) - names.begin();
  const std::string theirs = close.empty() ? "NAME IN THE FILE" : written_[static_cast<std::size_t>(at)];
  return fail({.file = name(),
               .line = header_line_,
               .field = std::string(base),
               .found = fmt::format("columns {}", fmt::join(written_, ", ")),
               .expected = quantity == Quantity::none ? fmt::format("a column {}", base)
                                                      : fmt::format("a column {} with its unit ({})", base, all),
               .advice = fmt::format("name the column in [columns]: {} = \"{}\"{}", wanted, theirs,
                                     close.empty() ? "" : " (the nearest there is)")});
}

Expected<std::optional<TableReader::Slot>> TableReader::find_time(std::string_view base) {
  const auto column = column_of(base);
  if (!column) return std::optional<Slot>();
  const ColumnName name = split_column_name(header_[*column]);
  if (name.unit == nullptr || name.unit->quantity != Quantity::time) {
    return fail({.file = this->name(),
                 .line = header_line_,
                 .field = written_[*column],
                 .found = name.unit == nullptr ? "no unit" : fmt::format("the unit {}", name.unit->text),
                 .expected = "_s, _ms, _us or _ns",
                 .advice = fmt::format("name the unit in [columns]: {}_s = \"{}\"", base, written_[*column])});
  }
  const int digits = name.unit->suffix == "s" ? 9 : name.unit->suffix == "ms" ? 6 : name.unit->suffix == "us" ? 3 : 0;
  return slot_for(*column, Kind::time, 1.0, digits, fmt::format("a time in {}", name.unit->text));
}

std::optional<TableReader::Slot> TableReader::find_text(std::string_view base) {
  const auto column = column_of(base);
  if (!column) return std::nullopt;
  return slot_for(*column, Kind::text, 1.0, 0, "text");
}

Error TableReader::complaint(Slot slot, std::string found, std::string expected, std::string advice) const {
  return {.file = name(),
          .line = line_number(),
          .field = slots_[slot].label,
          .found = std::move(found),
          .expected = std::move(expected),
          .advice = std::move(advice)};
}

bool TableReader::next() {
  std::string_view line;
  while (!error_) {
    if (!lines_.next(line)) {
      error_ = lines_.error();
      return false;
    }
    const char* const first = skip_blanks(line.data(), line.data() + line.size());
    if (first == line.data() + line.size() || *first == '#' || *first == '%') continue;
    if (parse_row(line)) {
      ++rows_;
      return true;
    }
  }
  return false;
}

// False when the row is left out, or on an Error.
bool TableReader::parse_row(std::string_view line) {
  const char* p = line.data();
  const char* const end = p + line.size();
  for (std::size_t i = 0; i < fields_; ++i) {
    p = skip_blanks(p, end);
    if (p == end && (delimiter_ == ' ' || i > 0)) {
      // An empty last field is a missing value where a delimiter announced it.
      const bool announced = delimiter_ != ' ' && i + 1 == fields_ && line.find_last_not_of(" ") != line.npos &&
                             line[line.find_last_not_of(" ")] == delimiter_;
      if (!announced) {
        faults_.add("line cut short", lines_.line_number(), fmt::format("{} of {} fields", i, fields_));
        return false;
      }
    }
    if (const auto& slot = plan_[i]) {
      p = parse_field(slots_[*slot], p, end);
      if (p == nullptr) return false;
    } else {
      p = field_end(p, end);
    }
    if (p != end) ++p;
  }
  if (p != end && skip_blanks(p, end) != end) {
    faults_.add("line too long", lines_.line_number(), fmt::format("more than {} fields", fields_));
    return false;
  }
  return true;
}

const char* TableReader::field_end(const char* p, const char* end) const {
  if (delimiter_ == ' ') {
    while (p != end && !blank(*p)) ++p;
    return p;
  }
  if (p != end && *p == '"') {
    const void* const quote = std::memchr(p + 1, '"', static_cast<std::size_t>(end - p - 1));
    if (quote != nullptr) p = static_cast<const char*>(quote);
  }
  const void* const found = p == end ? nullptr : std::memchr(p, delimiter_, static_cast<std::size_t>(end - p));
  return found == nullptr ? end : static_cast<const char*>(found);
}

// Returns the end of the field; null on an Error.
const char* TableReader::parse_field(Column& slot, const char* p, const char* end) {
  if (slot.kind == Kind::number) {
    double x = 0.0;
    const auto [stop, code] = fast_float::from_chars_advanced(
        p, end, x, fast_float::parse_options{fast_float::chars_format::general, point_});
    if (code == std::errc() && (stop == end || *stop == delimiter_ || blank(*stop))) {
      const char* const behind = delimiter_ == ' ' ? stop : skip_blanks(stop, end);
      if (behind == end || *behind == delimiter_ || blank(*behind)) {
        slot.value = std::isfinite(x) ? x * slot.factor : nan;
        return behind;
      }
    }
    return parse_slowly(slot, p, end);
  }
  if (slot.kind == Kind::time) {
    std::string_view rest(p, static_cast<std::size_t>(end - p));
    const auto value = parse_decimal(rest, slot.digits, point_);
    const char* const stop = end - rest.size();
    if (value && (stop == end || *stop == delimiter_ || blank(*stop))) {
      slot.nanoseconds = *value;
      return delimiter_ == ' ' ? stop : field_end(stop, end);
    }
  }
  return parse_slowly(slot, p, end);
}

// Quoted fields, missing values, text; anything else is an Error.
const char* TableReader::parse_slowly(Column& slot, const char* p, const char* end) {
  const char* const stop = field_end(p, end);
  std::string_view field = trimmed({p, static_cast<std::size_t>(stop - p)});
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
    field = trimmed(field.substr(1, field.size() - 2));
  if (slot.kind == Kind::text) {
    slot.text = field;
    return stop;
  }
  std::string_view number = field;
  if (!number.empty() && number.front() == '+') number.remove_prefix(1);
  if (slot.kind == Kind::number) {
    double x = nan;
    const auto [last, code] =
        fast_float::from_chars_advanced(number.data(), number.data() + number.size(), x,
                                        fast_float::parse_options{fast_float::chars_format::general, point_});
    const bool whole = code == std::errc() && last == number.data() + number.size();
    if (whole || stands_for_nothing(field)) {
      slot.value = whole && std::isfinite(x) ? x * slot.factor : nan;
      return stop;
    }
  } else {
    std::string_view rest = number;
    const auto value = parse_decimal(rest, slot.digits, point_);
    if ((value && rest.empty()) || stands_for_nothing(field)) {
      slot.nanoseconds = value ? *value : missing;
      return stop;
    }
  }
  error_ = {.file = name(),
            .line = line_number(),
            .field = slot.label,
            .found = fmt::format("'{}'", field.substr(0, 40)),
            .expected = slot.unit,
            .advice = "correct or delete the line; when the column is another one, correct [columns]"};
  return nullptr;
}

}  // namespace versine::io
