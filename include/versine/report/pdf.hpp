// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/report/drawing.hpp"

namespace versine::report {

struct PdfPage {
  const Drawing* drawing = nullptr;
  std::string bookmark;  ///< in the outline; empty: none
};
struct PdfInfo {
  std::string title, subject, created;  ///< created: ISO 8601
};

/// Vector pages through Cairo, text through Pango: embedded fonts, other scripts from whatever font has them,
/// searchable. Each drawing lies in the middle of A4 landscape.
[[nodiscard]] Expected<void> write_pdf(const std::filesystem::path& path, const std::vector<PdfPage>& pages,
                                       const PdfInfo& info);

}  // namespace versine::report
