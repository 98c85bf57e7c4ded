// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "versine/io/alignment_file.hpp"
#include "versine/io/landxml.hpp"

namespace versine::cli {

namespace {

struct AlignmentOptions {
  io::AlignmentFile file;
  std::string landxml;
  design::AuditLimits limits;
  double max_gap_mm = 20.0, max_kink_mrad = 2.0;
  bool json = false;
};

nlohmann::json to_json(const design::Imported& imported) {
  nlohmann::json out = {{"name", imported.name}, {"usable", imported.alignment.has_value()}};
  if (imported.alignment) {
    const design::Alignment& a = *imported.alignment;
    out["length_m"] = a.length();
    out["horizontal_elements"] = a.horizontal.elements().size();
    out["profile_points"] = a.profile.points().size();
    out["cant_points"] = a.cant.points().size();
    out["mileage_start_m"] = a.mileage(0.0);
    out["mileage_end_m"] = a.mileage(a.length());
    out["crs"] = a.crs;
  } else {
    out["error"] = imported.alignment.error().message();
  }
  out["findings"] = nlohmann::json::array();
  for (const design::AuditFinding& f : imported.audit) {
    out["findings"].push_back({{"verdict", to_string(f.verdict)},
                               {"kind", f.kind},
                               {"element", f.element},
                               {"distance_m", f.distance},
                               {"value", f.value},
                               {"limit", f.limit},
                               {"unit", f.unit},
                               {"detail", f.detail}});
  }
  return out;
}

void print(const design::Imported& imported) {
  fmt::print("alignment '{}'\n", imported.name);
  if (imported.alignment) {
    const design::Alignment& a = *imported.alignment;
    fmt::print("  length {:.3f} m, {} horizontal elements, {} profile points, {} cant points\n  mileage {} to {}{}\n",
               a.length(), a.horizontal.elements().size(), a.profile.points().size(), a.cant.points().size(),
               design::format_mileage(a.mileage(0.0)), design::format_mileage(a.mileage(a.length())),
               a.crs.empty() ? "" : ", " + a.crs);
  } else {
    fmt::print("  not usable: {}\n", imported.alignment.error().message());
  }
  for (const design::AuditFinding& f : imported.audit) fmt::print("  {}\n", to_string(f));
  if (imported.audit.empty()) fmt::print("  the audit found nothing\n");
}

int run(const AlignmentOptions& options) {
  const auto all = io::read_alignments(options.file, options.limits);
  if (!all) return report(all.error());
  bool usable = true;
  nlohmann::json out = nlohmann::json::array();
  std::vector<design::Alignment> alignments;
  for (const design::Imported& imported : *all) {
    usable = usable && imported.alignment;
    if (imported.alignment) alignments.push_back(*imported.alignment);
    if (options.json)
      out.push_back(to_json(imported));
    else
      print(imported);
  }
  if (options.json)
    fmt::print("{}\n", nlohmann::json{{"file", options.file.path.string()}, {"alignments", out}}.dump(2));
  if (!options.landxml.empty()) {
    if (const auto written = io::write_landxml(options.landxml, alignments); !written) return report(written.error());
  }
  return usable ? good : unacceptable;
}

}  // namespace

int audit_alignment(const std::filesystem::path& file, bool json) {
  AlignmentOptions options;
  options.file.path = file;
  options.json = json;
  return run(options);
}

void add_alignment(CLI::App& app, int& exit) {
  CLI::App* command = app.add_subcommand("alignment", "Audit a design alignment (LandXML, DB TRA/GRA), or convert it");
  auto options = std::make_shared<AlignmentOptions>();
  command->add_option("file", options->file.path, "LandXML (.xml) or DB TRA (.tra)")->required();
  command->add_option("--gradients", options->file.gradients, "DB GRA file with the heights of a TRA");
  command->add_option("--stationing", options->file.stationing, "TRA of the stationing line that the GRA refers to");
  command->add_option("--landxml", options->landxml, "Write the usable alignments to this LandXML file");
  command->add_option("--max-gap-mm", options->max_gap_mm, "Refuse gaps and length misfits above this")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--max-kink-mrad", options->max_kink_mrad, "Refuse kinks above this")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--json", options->json, "Machine-readable audit");
  command->callback([options, &exit] {
    options->limits.gap_refused = options->max_gap_mm * 1e-3;
    options->limits.kink_refused = options->max_kink_mrad * 1e-3;
    exit = run(*options);
  });
}

}  // namespace versine::cli
