// SPDX-License-Identifier: Apache-2.0
#include "versine/io/alignment_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "versine/io/landxml.hpp"
#include "versine/io/tra_gra.hpp"

namespace versine::io {

namespace {
std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}
}  // namespace

bool is_alignment(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  return ending == ".xml" || ending == ".landxml" || ending == ".tra" || ending == ".gra";
}

Expected<std::vector<design::Imported>> read_alignments(const AlignmentFile& file, const design::AuditLimits& limits) {
  const std::string ending = ending_of(file.path);
  if (ending == ".xml" || ending == ".landxml") return read_landxml(file.path, limits);
  if (ending == ".tra") {
    const auto given = [](const std::filesystem::path& p) {
      return p.empty() ? std::optional<std::filesystem::path>() : p;
    };
    auto imported = read_tra_gra(file.path, given(file.gradients), given(file.stationing), limits);
    if (!imported) return tl::unexpected(imported.error());
    return std::vector<design::Imported>{*std::move(imported)};
  }
  return fail({.file = file.path.string(),
               .field = "alignment",
               .found = "the ending '" + ending + "'",
               .expected = ".xml or .landxml (LandXML 1.2), or .tra (DB Verm.esn)",
               .advice = ending == ".gra" ? "a GRA holds heights only: name its TRA, and the GRA as gradients"
                                          : "export the design as LandXML 1.2"});
}

Expected<design::Alignment> read_alignment(const AlignmentFile& file, const std::string& name,
                                           const design::AuditLimits& limits, design::Audit* audit) {
  auto all = read_alignments(file, limits);
  if (!all) return tl::unexpected(all.error());
  std::vector<std::string> names;
  for (design::Imported& imported : *all) {
    names.push_back(imported.name);
    if (name.empty() ? all->size() > 1 : imported.name != name) continue;
    if (audit != nullptr) *audit = imported.audit;
    return std::move(imported.alignment);
  }
  return fail({.file = file.path.string(),
               .field = "alignment",
               .found = name.empty() ? "several alignments and no name" : "no alignment named '" + name + "'",
               .expected = fmt::format("one of: '{}'", fmt::join(names, "', '")),
               .advice = "name the alignment that was surveyed"});
}

}  // namespace versine::io
