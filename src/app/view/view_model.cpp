// SPDX-License-Identifier: Apache-2.0
#include "versine/app/view_model.hpp"

#include <fmt/format.h>

#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>

#include "versine/app/partial_survey.hpp"
#include "versine/app/progress_file.hpp"
#include "versine/app/version.hpp"
#include "versine/app/view_georef.hpp"
#include "versine/app/view_survey.hpp"
#include "versine/io/background_map.hpp"
#include "versine/io/input_stream.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

constexpr const char* format = "versine run 1";

Error no_result(const fs::path& folder, std::string found) {
  return {.file = folder.string(),
          .found = std::move(found),
          .expected = "the result folder of a Versine job, with its run.json",
          .advice = "give the folder that the job printed as 'Result:', or run the job first"};
}

fs::path cleaned(const fs::path& folder) {
  fs::path out = fs::absolute(folder).lexically_normal();
  return out.has_filename() ? out : out.parent_path();
}

/// Beside the result, which is never changed and may be replaced.
fs::path marks_file(const fs::path& folder) {
  return fs::path(folder).concat(".marks.json");
}

Expected<void> write_marks(const fs::path& path, const std::string& text) {
  const json marks = json::parse(text, nullptr, false);
  if (!marks.is_array()) return fail({.found = "marks that are no JSON array"});
  const fs::path part = fs::path(path).concat(".part");
  std::error_code code;
  {
    std::ofstream file(part, std::ios::binary);
    file << marks.dump(1) << '\n';
    if (!file.flush()) code = std::make_error_code(std::errc::io_error);
  }
  if (!code) fs::rename(part, path, code);
  if (!code) return {};
  return fail({.file = path.string(),
               .found = "that it cannot be written",
               .advice = "allow writing beside the result; until then the browser keeps the marks"});
}

/// Follows one folder: opens what is there, and again when a job has replaced it. Several threads ask at once.
class Follower {
 public:
  Follower(fs::path folder, std::optional<fs::path> compare, std::string background)
      : folder_(std::move(folder)), compare_(std::move(compare)), background_(std::move(background)) {}

  Expected<void> start() {
    const std::lock_guard lock(mutex_);
    if (fs::exists(folder_ / "run.json")) return open();
    if (running_job(folder_)) return {};
    return tl::unexpected(
        no_result(folder_, fs::is_directory(folder_) ? "a folder without run.json" : "no such folder"));
  }

  std::shared_ptr<const ViewContent> content() {
    const std::lock_guard lock(mutex_);
    std::error_code code;
    const auto written = fs::last_write_time(folder_ / "run.json", code);
    if (code) {
      open_partial();
    } else if (written != written_) {  // a result that cannot be opened is tried again only when it has changed
      (void)open();
    }
    return content_;
  }

  std::string result() {
    if (const auto now = content()) return now->result_json();
    return json{{"kind", "waiting"}, {"title", folder_.filename().string()}, {"failure", failure()}}.dump();
  }

  std::string progress() {
    (void)content();
    const auto job = running_job(folder_);
    json out{{"running", job.has_value()}, {"background", background_}};
    {
      const std::lock_guard lock(mutex_);
      out["generation"] = generation_;
      out["opened"] = content_ != nullptr;
      out["failure"] = failure_;
    }
    if (job) {
      const auto text = io::read_text(*job / ProgressFile::name);
      const json state = text ? json::parse(*text, nullptr, false) : json();
      if (state.is_object()) out.update(state);
    }
    return out.dump();
  }

 private:
  /// Before the first result: what the job has so far, or that it has ended with nothing.
  void open_partial() {
    const auto job = running_job(folder_);
    if (!job) {
      if (!failure_.empty()) return;
      failure_ = "The job has ended without a result; its own messages say why. Run it again: this page follows.";
      content_ = nullptr;
      ++generation_;
      return;
    }
    const auto newest = newest_partial(*job);
    if (!failure_.empty()) {  // another job has been started
      failure_.clear();
      ++generation_;
    }
    if (!newest || *newest == partial_) return;
    auto opened = open_view(*newest);
    if (!opened) return;  // it was replaced just now
    partial_ = *newest;
    content_ = std::make_shared<const ViewContent>(std::move(*opened));
    ++generation_;
  }

  Expected<void> open() {
    std::error_code code;
    written_ = fs::last_write_time(folder_ / "run.json", code);
    auto opened = open_view(folder_, compare_);
    ++generation_;
    if (!opened) {
      failure_ = opened.error().message();
      content_ = nullptr;
      return tl::unexpected(opened.error());
    }
    failure_.clear();
    content_ = std::make_shared<const ViewContent>(std::move(*opened));
    return {};
  }
  std::string failure() {
    const std::lock_guard lock(mutex_);
    return failure_;
  }

  fs::path folder_;
  std::optional<fs::path> compare_;
  std::string background_;  ///< its name; empty: none
  std::mutex mutex_;
  std::shared_ptr<const ViewContent> content_;
  std::string failure_;
  fs::file_time_type written_;
  fs::path partial_;  ///< the part of a running job that is open
  int generation_ = 0;
};

}  // namespace

Expected<ViewContent> open_view(const fs::path& given, const std::optional<fs::path>& compare) {
  const fs::path folder = cleaned(given);
  if (!fs::exists(folder / "run.json")) {
    return tl::unexpected(no_result(given, fs::is_directory(folder) ? "a folder without run.json" : "no such folder"));
  }
  const auto text = io::read_text(folder / "run.json");
  if (!text) return tl::unexpected(text.error());
  const json run = json::parse(*text, nullptr, false);
  if (!run.is_object()) {
    return fail({.file = (folder / "run.json").string(),
                 .found = "text that is no JSON, or is cut short",
                 .expected = "what a Versine job wrote",
                 .advice = "run the job again, or copy the whole folder once more"});
  }
  if (run.value("format", "") != format) {
    return fail({.file = (folder / "run.json").string(),
                 .field = "format",
                 .found = fmt::format("'{}', written by version {}", run.value("format", "none"),
                                      run.value("version", "unknown")),
                 .expected = fmt::format("'{}', as version {} writes it", format, version()),
                 .advice = "run the job again with this version, or open the result with the version that wrote it"});
  }
  const std::string command = run.value("command", "");
  if (command == "survey" || command == "geometry") return open_survey_view(folder, *text, compare);
  if (command == "georef") return open_georef_view(folder, *text, compare);
  return fail({.file = (folder / "run.json").string(),
               .field = "command",
               .found = fmt::format("a result of 'versine {}'", command),
               .expected = "one of survey, geometry or georef",
               .advice = "its own files show it; 'versine report' makes a page of it where it can"});
}

Expected<ViewContent> follow_view(const fs::path& folder, const std::optional<fs::path>& compare,
                                  const std::optional<fs::path>& background) {
  std::shared_ptr<const io::BackgroundMap> ground;
  if (background) {
    auto opened = io::BackgroundMap::open(*background);
    if (!opened) return tl::unexpected(opened.error());
    ground = std::make_shared<const io::BackgroundMap>(std::move(*opened));
  }
  auto follower = std::make_shared<Follower>(cleaned(folder), compare, ground ? ground->name() : std::string());
  if (auto started = follower->start(); !started) return tl::unexpected(started.error());
  ViewContent out;
  out.result_json = [follower] { return follower->result(); };
  out.progress_json = [follower] { return follower->progress(); };
  out.values_json = [follower](double x) {
    const auto now = follower->content();
    return now && now->values_json ? now->values_json(x) : std::string("{}");
  };
  out.series = [follower](const std::string& id, double from, double to,
                          std::size_t buckets) -> std::optional<std::string> {
    const auto now = follower->content();
    return now && now->series ? now->series(id, from, to, buckets) : std::nullopt;
  };
  out.map = [follower](const std::string& part) -> std::optional<std::string> {
    const auto now = follower->content();
    return now && now->map ? now->map(part) : std::nullopt;
  };
  out.constraints_json = [follower] {
    const auto now = follower->content();
    return now && now->constraints_json ? now->constraints_json() : std::string("[]");
  };
  out.report = [follower]() -> std::optional<std::string> {
    const auto now = follower->content();
    return now && now->report ? now->report() : std::nullopt;
  };
  if (ground) {
    out.background = [follower, ground](const std::array<double, 4>& window, int width,
                                        int height) -> std::optional<std::string> {
      const auto now = follower->content();
      if (!now || now->crs.empty()) return std::nullopt;
      auto png = ground->png(now->crs, window, width, height);
      return png ? std::optional(std::move(*png)) : std::nullopt;
    };
  }
  const fs::path marks = marks_file(cleaned(folder));
  out.marks_json = [marks] {
    const auto text = io::read_text(marks);
    return text && json::accept(*text) ? *text : std::string("[]");
  };
  out.put_marks = [marks](const std::string& text) { return write_marks(marks, text); };
  out.put_constraints = [follower](const std::string& text) -> Expected<void> {
    const auto current = follower->content();
    if (!current || !current->put_constraints) return fail({.found = "no result that is open for review"});
    return current->put_constraints(text);
  };
  return out;
}

}  // namespace versine::app
