// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "versine/io/column_units.hpp"
#include "versine/io/fault_log.hpp"
#include "versine/io/line_reader.hpp"
#include "versine/io/recording_description.hpp"

namespace versine::io {

/// Rows of a text table, one at a time, only the columns that were asked for. Use: `open`, ask for columns (each
/// answers with a slot), then `next` until false, then look at `error`.
class TableReader {
 public:
  /// Slot of a column that was asked for.
  using Slot = std::size_t;
  static constexpr std::int64_t missing = std::numeric_limits<std::int64_t>::min();

  /// Reads as far as the header. Lines that begin with '%' or '#' are comments; the last one before the data serves as
  /// header when it has as many words as the data have fields and the data begin at once.
  [[nodiscard]] static Expected<TableReader> open(LineReader lines, const TableFile& file);

  /// Column `base` with a unit of `quantity` in its name; its numbers come in SI and radians, times `scale`.
  /// A column named `base`_count has no unit: `scale` alone makes it SI.
  /// Nothing if there is none; an Error if its unit is missing or is one of another quantity.
  [[nodiscard]] Expected<std::optional<Slot>> find(std::string_view base, Quantity quantity, double scale = 1.0);
  /// The same where the column must be there; the Error names the header and the nearest column.
  [[nodiscard]] Expected<Slot> need(std::string_view base, Quantity quantity, double scale = 1.0);
  /// A time in any unit of time, exact: read with `nanoseconds`.
  [[nodiscard]] Expected<std::optional<Slot>> find_time(std::string_view base);
  /// A column as text; nothing if there is none.
  [[nodiscard]] std::optional<Slot> find_text(std::string_view base);
  [[nodiscard]] bool has(std::string_view base) const;
  /// Any column as text, by its index; for looking into a file.
  [[nodiscard]] Slot text_column(std::size_t column) { return slot_for(column, Kind::text, 1.0, 0, "text"); }

  /// The next row; false at the end and on an Error. Rows with too few or too many fields are left out and logged.
  [[nodiscard]] bool next();
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  [[nodiscard]] double number(Slot slot) const { return slots_[slot].value; }  ///< NaN: empty or not finite
  [[nodiscard]] std::int64_t nanoseconds(Slot slot) const { return slots_[slot].nanoseconds; }  ///< or `missing`
  [[nodiscard]] std::string_view text(Slot slot) const { return slots_[slot].text; }
  /// A complete Error about a field of the present row.
  [[nodiscard]] Error complaint(Slot slot, std::string found, std::string expected, std::string advice) const;
  [[nodiscard]] const std::string& label(Slot slot) const { return slots_[slot].label; }  ///< name in the file

  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }  ///< Versine's names, with units
  [[nodiscard]] const std::vector<std::string>& written() const { return written_; }  ///< as in the file
  [[nodiscard]] const std::string& name() const { return lines_.name(); }
  [[nodiscard]] std::size_t line_number() const { return lines_.line_number(); }
  [[nodiscard]] std::size_t rows() const { return rows_; }     ///< given so far
  [[nodiscard]] char delimiter() const { return delimiter_; }  ///< ' ': any run of blanks and tabs
  FaultLog& faults() { return faults_; }

 private:
  enum class Kind { number, time, text };
  struct Column {
    std::size_t column = 0;
    Kind kind = Kind::number;
    double factor = 1.0;
    int digits = 9;
    std::string label, unit;
    double value = 0.0;
    std::int64_t nanoseconds = missing;
    std::string_view text;
  };

  explicit TableReader(LineReader lines) : lines_(std::move(lines)) {}
  Expected<void> read_header(const TableFile& file);
  Expected<void> map_columns(const TableFile& file, const std::vector<std::string>& written, bool numbered);
  [[nodiscard]] std::optional<std::size_t> column_of(std::string_view base) const;
  Slot slot_for(std::size_t column, Kind kind, double factor, int digits, std::string unit);
  bool parse_row(std::string_view line);
  const char* parse_field(Column& slot, const char* p, const char* end);
  const char* parse_slowly(Column& slot, const char* p, const char* end);
  const char* field_end(const char* p, const char* end) const;

  LineReader lines_;
  std::vector<std::string> header_;        // Versine's names; empty for columns nobody can ask for
  std::vector<std::string> written_;       // as in the file
  std::vector<std::optional<Slot>> plan_;  // per column
  std::vector<Column> slots_;
  std::size_t header_line_ = 0, fields_ = 0, rows_ = 0;
  char delimiter_ = ',', point_ = '.';
  FaultLog faults_;
  std::optional<Error> error_;
};

}  // namespace versine::io
