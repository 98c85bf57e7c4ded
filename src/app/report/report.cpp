// SPDX-License-Identifier: Apache-2.0
#include "versine/app/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>

#include "report_reading.hpp"

namespace versine::app {

namespace {

const std::vector<std::string> known_formats{"html", "pdf", "xlsx"};

Expected<void> check_formats(const std::vector<std::string>& formats) {
  for (const std::string& f : formats) {
    if (std::find(known_formats.begin(), known_formats.end(), f) != known_formats.end()) continue;
    return fail({.field = "report.formats",
                 .found = "'" + f + "'",
                 .expected = fmt::format("some of {}", fmt::join(known_formats, ", ")),
                 .advice = "for example formats = [\"html\", \"pdf\"], or --format html,pdf"});
  }
  return {};
}

Expected<void> write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  if (file.write(text.data(), static_cast<std::streamsize>(text.size())).flush()) return {};
  return fail({.file = path.string(),
               .found = "that it cannot be written",
               .expected = "a writable place with free space",
               .advice = "check permissions and free space, or name another folder with --output"});
}

Expected<void> write_format(const std::filesystem::path& path, const std::string& format,
                            const report::Document& document, const report::Texts& texts) {
  if (format == "html") return write_text(path, report::to_html(document, texts));
  return format == "pdf" ? report::write_document_pdf(path, document) : report::write_document_xlsx(path, document);
}

struct Made {
  report::Document document;
  report::Texts texts;
  std::vector<std::string> formats;
};

Expected<Made> make_from(const std::filesystem::path& result, const ReportRequest& request) {
  const auto run = read_run(result);
  if (!run) return tl::unexpected(run.error());
  const auto settings = run->value("/settings/report"_json_pointer, nlohmann::ordered_json::object());
  Made out;
  out.formats = request.formats;
  if (out.formats.empty()) out.formats = settings.value("formats", std::vector<std::string>{});
  if (out.formats.empty()) out.formats = {"html"};
  if (auto done = check_formats(out.formats); !done) return tl::unexpected(done.error());
  auto texts = report::Texts::load(request.language.value_or(settings.value("language", "en")));
  if (!texts) return tl::unexpected(texts.error());
  out.texts = std::move(*texts);
  const std::string command = run->value("command", "");
  const auto named = [&](auto& report) {
    if (!request.shown_as.empty()) report.facts.folder = request.shown_as;
  };
  if (command == "survey" || command == "geometry") {
    auto report = read_survey_report(result, *run);
    if (!report) return tl::unexpected(report.error());
    named(*report);
    out.document = report::survey_document(*report, out.texts);
  } else if (command == "georef") {
    auto report = read_georef_report(result, *run);
    if (!report) return tl::unexpected(report.error());
    named(*report);
    out.document = report::georef_document(*report, out.texts);
  } else if (command == "plan") {
    auto report = read_plan_report(result, *run);
    if (!report) return tl::unexpected(report.error());
    named(*report);
    out.document = report::plan_document(*report, out.texts);
  } else {
    return fail({.file = (result / "run.json").string(),
                 .field = "command",
                 .found = "'" + command + "'",
                 .expected = "survey, geometry, georef or plan",
                 .advice = "there is no report of this kind of job"});
  }
  return out;
}

Expected<Made> make(const std::filesystem::path& result, const ReportRequest& request) {
  try {
    return make_from(result, request);
  } catch (const nlohmann::json::exception& error) {  // a number where a table should be: not as Versine writes it
    return fail({.file = (result / "run.json").string(),
                 .found = error.what(),
                 .expected = "the files of one result as Versine writes them",
                 .advice = "run the job again; the files were changed, or are of another version"});
  }
}

}  // namespace

void describe(ConfigVisitor& v, ReportConfig& c, bool with_cover) {
  v.value("formats", c.formats, {.doc = "Some of html, pdf, xlsx; none: html.", .example = "[\"html\", \"pdf\"]"});
  v.value("language", c.language, {.doc = "en, de, zh, or a file with the keys of data/texts/en.toml."});
  if (with_cover) {
    v.value("line", c.cover.line, {.doc = "On the cover; none: the title.", .example = "\"6240 Dresden - Chemnitz\""});
    v.value("track", c.cover.track, {.doc = "On the cover.", .example = "\"track 1\""});
    v.value("direction", c.cover.direction, {.doc = "On the cover.", .example = "\"with increasing mileage\""});
    v.value("date", c.cover.date, {.doc = "On the cover; none: the recording's first day, UTC."});
    v.value("shift", c.cover.shift, {.doc = "On the cover.", .example = "\"night, 23:30 - 03:10\""});
    v.value("operator", c.cover.operated_by, {.doc = "On the cover."});
    v.value("client", c.cover.client, {.doc = "On the cover."});
    v.value("trolley", c.cover.trolley, {.doc = "On the cover: make, number."});
    v.value("calibrated", c.cover.calibrated, {.doc = "On the cover: dates of its calibrations."});
  }
  v.value("remarks", c.cover.remarks, {.doc = "On the cover."});
}

Expected<report::Document> make_report(const std::filesystem::path& result, const ReportRequest& request) {
  auto made = make(result, request);
  if (!made) return tl::unexpected(made.error());
  return std::move(made->document);
}

Expected<std::vector<std::filesystem::path>> write_report(const std::filesystem::path& result,
                                                          const ReportRequest& request) {
  const auto made = make(result, request);
  if (!made) return tl::unexpected(made.error());
  const std::filesystem::path folder = request.output.empty() ? result : request.output;
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  std::vector<std::filesystem::path> files;
  for (const std::string& format : made->formats) {
    const auto path = folder / ("report." + format), fresh = folder / (".report.new." + format);
    auto done = write_format(fresh, format, made->document, made->texts);
    if (done) {
      std::filesystem::rename(fresh, path, code);
      if (code) done = fail({.file = path.string(), .found = code.message(), .expected = "a writable place"});
    }
    if (!done) {
      std::filesystem::remove(fresh, code);
      return tl::unexpected(done.error());
    }
    files.push_back(path);
  }
  return files;
}

Expected<void> check_report(const ReportConfig& config) {
  if (!config.present) return {};
  if (auto done = check_formats(config.formats); !done) return done;
  if (const auto texts = report::Texts::load(config.language); !texts) return tl::unexpected(texts.error());
  return {};
}

Expected<void> write_job_report(const ReportConfig& config, const std::filesystem::path& folder,
                                const std::filesystem::path& target) {
  if (!config.present) return {};
  const auto files = write_report(folder, {.shown_as = target.filename().string()});
  if (!files) return tl::unexpected(files.error());
  return {};
}

}  // namespace versine::app
