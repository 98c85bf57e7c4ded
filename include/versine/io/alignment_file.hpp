// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "versine/design/assemble.hpp"

namespace versine::io {

/// A design on disk. The format follows from the ending: .xml, .landxml: LandXML; .tra: DB TRA.
struct AlignmentFile {
  std::filesystem::path path;
  std::filesystem::path gradients;   ///< DB GRA of a TRA; may be empty
  std::filesystem::path stationing;  ///< TRA of the stationing line that the GRA's mileages refer to; may be empty
};

/// By its ending: a design in a format that is known here (a GRA, too, which is read with its TRA).
[[nodiscard]] bool is_alignment(const std::filesystem::path& path);

/// All alignments of a file, audited.
[[nodiscard]] Expected<std::vector<design::Imported>> read_alignments(const AlignmentFile& file,
                                                                      const design::AuditLimits& limits = {});

/// The one alignment of that name, or the only one when `name` is empty; its audit's lines in `audit` when given.
/// Fails with the names that are there.
[[nodiscard]] Expected<design::Alignment> read_alignment(const AlignmentFile& file, const std::string& name = {},
                                                         const design::AuditLimits& limits = {},
                                                         design::Audit* audit = nullptr);

}  // namespace versine::io
