// SPDX-License-Identifier: Apache-2.0
#include "versine/batch/receipt.hpp"

#include <nlohmann/json.hpp>

#include "versine/core/file_system.hpp"
#include "versine/io/sha256.hpp"

namespace versine::batch {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {
constexpr const char* receipt_format = "versine receipt 1";

Json reason_json(const Error& e) {
  return {{"file", e.file},   {"line", e.line},         {"field", e.field},
          {"found", e.found}, {"expected", e.expected}, {"advice", e.advice}};
}

Failure damaged(const fs::path& path, std::string found) {
  return {Exit::again,
          {.file = path.string(),
           .found = std::move(found),
           .expected = "a receipt as it was written",
           .advice = "'versine batch verify' withdraws it, 'run --missing' repeats the unit"}};
}

Failure differs(const fs::path& path) {
  return {Exit::differs,
          {.file = path.string(),
           .found = "a receipt of another result than this execution's",
           .expected = "the same bytes wherever a unit runs",
           .advice = "compare the machines' builds and libraries; 'verify' tells whether the first is damaged"}};
}
}  // namespace

std::string to_text(const Receipt& r) {
  Json outputs = Json::array();
  for (const Output& o : r.outputs) outputs.push_back({{"name", o.name}, {"sha256", o.sha256}, {"bytes", o.bytes}});
  Json j{
      {"format", receipt_format}, {"unit", r.unit}, {"state", r.rejection ? "rejected" : "done"}, {"outputs", outputs}};
  if (r.rejection) j["reason"] = reason_json(*r.rejection);
  const auto dump = [&] { return j.dump(1, ' ', false, Json::error_handler_t::replace); };
  const std::string check = io::sha256(dump());
  j["check"] = check;
  return dump() + "\n";
}

Expected<Receipt> receipt_from(const std::string& text) {
  const auto bad = [](std::string why) { return fail({.field = "receipt", .found = std::move(why)}); };
  try {
    const Json j = Json::parse(text);
    Receipt r;
    r.unit = j.at("unit");
    for (const auto& o : j.at("outputs")) r.outputs.push_back({o.at("name"), o.at("sha256"), o.at("bytes")});
    if (j.contains("reason")) {
      const auto& e = j.at("reason");
      r.rejection = Error{e.at("file"), e.at("line"), e.at("field"), e.at("found"), e.at("expected"), e.at("advice")};
    }
    if (to_text(r) != text) return bad("a content that does not agree with its check sum");
    return r;
  } catch (const nlohmann::json::exception& e) {
    return bad(e.what());
  }
}

Outcome<Commit> commit(const Store& store, const Receipt& receipt) {
  const std::string text = to_text(receipt);
  const auto written = store.write_tmp(text);
  if (!written) return tl::unexpected(written.error());
  const fs::path target = store.receipt(receipt.unit);
  std::error_code code, ignored;
  fs::create_directories(target.parent_path(), code);
  if (!code) fs::create_hard_link(*written, target, code);
  fs::remove(*written, ignored);
  if (code == std::errc::file_exists) {
    const auto there = read_file(target);
    if (!there) return tl::unexpected(there.error());
    if (!receipt_from(*there)) return tl::unexpected(damaged(target, "a damaged receipt"));
    if (*there != text) return tl::unexpected(differs(target));
    return Commit::duplicate;
  }
  if (code || !flush_one(target.parent_path())) {
    return failure(Exit::again, {.file = target.string(),
                                 .found = code.message(),
                                 .expected = "a store whose file system has hard links, with free space",
                                 .advice = "run the same command again when it has"});
  }
  return Commit::created;
}

bool has_receipt(const Store& store, const std::string& unit) {
  std::error_code code;
  return fs::exists(store.receipt(unit), code);
}

Outcome<std::optional<Receipt>> find_receipt(const Store& store, const std::string& unit) {
  if (!has_receipt(store, unit)) return std::optional<Receipt>();
  const auto text = read_file(store.receipt(unit));
  if (!text) return tl::unexpected(text.error());
  auto r = receipt_from(*text);
  if (!r) return tl::unexpected(damaged(store.receipt(unit), r.error().found));
  if (r->unit != unit) return tl::unexpected(damaged(store.receipt(unit), "the receipt of another unit"));
  return std::optional<Receipt>(std::move(*r));
}

}  // namespace versine::batch
