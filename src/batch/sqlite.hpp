// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace versine::batch {

struct SqliteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A connection that throws SqliteError; never seen outside this domain.
class Database {
 public:
  Database(const std::filesystem::path& path, int flags) {
    sqlite3* raw = nullptr;
    const int code = sqlite3_open_v2(path.string().c_str(), &raw, flags, nullptr);
    db_.reset(raw);
    if (code != SQLITE_OK) complain();
  }
  void run(const char* sql) {
    if (sqlite3_exec(db_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) complain();
  }
  void close() {
    if (sqlite3_close(db_.release()) != SQLITE_OK) throw SqliteError("a database that cannot be closed");
  }
  [[nodiscard]] std::int64_t last_row() const { return sqlite3_last_insert_rowid(db_.get()); }
  [[nodiscard]] sqlite3* get() const { return db_.get(); }
  [[noreturn]] void complain() const { throw SqliteError(sqlite3_errmsg(db_.get())); }

 private:
  struct Closer {
    void operator()(sqlite3* p) const { sqlite3_close(p); }
  };
  std::unique_ptr<sqlite3, Closer> db_;
};

/// A prepared statement; parameters and columns count from 1 and 0, as in SQLite.
class Statement {
 public:
  struct Blob {
    std::string_view bytes;
  };
  [[nodiscard]] static Blob blob(std::string_view bytes) { return {bytes}; }

  Statement(Database& db, const char* sql) : db_(db) {
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(db.get(), sql, -1, &raw, nullptr) != SQLITE_OK) db.complain();
    statement_.reset(raw);
  }
  template <class... T>
  Statement& bind(const T&... values) {
    int i = 0;
    (put(++i, values), ...);
    return *this;
  }
  /// True: there is a row.
  bool step() {
    const int code = sqlite3_step(statement_.get());
    if (code != SQLITE_ROW && code != SQLITE_DONE) db_.complain();
    if (code == SQLITE_DONE) sqlite3_reset(statement_.get());
    return code == SQLITE_ROW;
  }
  void release() { statement_.reset(); }
  [[nodiscard]] std::int64_t integer(int i) const { return sqlite3_column_int64(statement_.get(), i); }
  [[nodiscard]] double number(int i) const { return sqlite3_column_double(statement_.get(), i); }
  [[nodiscard]] std::string text(int i) const { return std::string(bytes(i)); }
  [[nodiscard]] std::string_view bytes(int i) const {
    const auto* p = static_cast<const char*>(sqlite3_column_blob(statement_.get(), i));
    return {p, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), i))};
  }

 private:
  struct Closer {
    void operator()(sqlite3_stmt* p) const { sqlite3_finalize(p); }
  };
  void check(int code) {
    if (code != SQLITE_OK) db_.complain();
  }
  void put(int i, std::int64_t x) { check(sqlite3_bind_int64(statement_.get(), i, x)); }
  void put(int i, std::size_t x) { put(i, static_cast<std::int64_t>(x)); }
  void put(int i, int x) { put(i, static_cast<std::int64_t>(x)); }
  void put(int i, double x) { check(sqlite3_bind_double(statement_.get(), i, x)); }
  void put(int i, std::nullptr_t) { check(sqlite3_bind_null(statement_.get(), i)); }
  void put(int i, const char* s) { put(i, std::string(s)); }
  void put(int i, const std::string& s) {
    check(sqlite3_bind_text(statement_.get(), i, s.data(), static_cast<int>(s.size()), SQLITE_TRANSIENT));
  }
  void put(int i, const Blob& b) {
    check(sqlite3_bind_blob(statement_.get(), i, b.bytes.data(), static_cast<int>(b.bytes.size()), SQLITE_TRANSIENT));
  }

  Database& db_;
  std::unique_ptr<sqlite3_stmt, Closer> statement_;
};

}  // namespace versine::batch
