// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/report/drawing.hpp"
#include "versine/report/table.hpp"
#include "versine/report/texts.hpp"

namespace versine::report {

/// A chapter of a report: one or more pages under one title.
struct Section {
  std::string id, title;
  std::vector<Drawing> pages;
};

/// A report, laid out: what HTML and PDF show, and the tables that go into a workbook.
struct Document {
  std::string title;     ///< "Track geometry survey"
  std::string subject;   ///< line and track
  std::string footer;    ///< signs and units, on every page
  std::string source;    ///< result folder, version, limits: on every page
  std::string created;   ///< ISO 8601, of the run
  std::string language;  ///< for the page's `lang`
  std::vector<Section> sections;
  std::vector<Table> tables;
};

/// Where a page's content goes, below its head and above its foot.
[[nodiscard]] Box content_box(const Drawing& page);
/// Draws head, foot and page number on every page; to be called once, when all pages are there.
void finish(Document& document, const Texts& texts);

/// One file that opens by double click and prints to A4 landscape: no script, no other file. Well-formed XML.
[[nodiscard]] std::string to_html(const Document& document, const Texts& texts);
[[nodiscard]] Expected<void> write_document_pdf(const std::filesystem::path& path, const Document& document);
/// A sheet for each table, numbers as numbers.
[[nodiscard]] Expected<void> write_document_xlsx(const std::filesystem::path& path, const Document& document);

}  // namespace versine::report
