// SPDX-License-Identifier: Apache-2.0
#include "versine/app/partial_survey.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>

#include "versine/app/survey_output.hpp"
#include "versine/app/version.hpp"
#include "versine/core/units.hpp"
#include "versine/io/write_trajectory.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_places = 2000;  // fixes on the plan
constexpr double most_points = 20'000;     // of a smoothed trajectory
constexpr auto least_wait = std::chrono::milliseconds(500);

/// Latitude and longitude in degrees, thinned.
template <class Samples>
json places(const Samples& samples) {
  json out = json::array();
  const std::size_t stride = 1 + samples.size() / most_places;
  for (std::size_t i = 0; i < samples.size(); i += stride) {
    const geodesy::Geodetic& p = samples[i].position;
    out.push_back({p.latitude / units::deg, p.longitude / units::deg});
  }
  return out;
}

double length_of(const geodesy::Trajectory& track) {
  double length = 0.0;
  for (std::size_t i = 1; i < track.size(); ++i) {
    if (track[i].segment != track[i - 1].segment) continue;
    length += 0.5 * (track[i].v_eb_n + track[i - 1].v_eb_n).norm() * (track[i].time - track[i - 1].time).seconds();
  }
  return length;
}

}  // namespace

PartialSurvey::PartialSurvey(const SurveyConfig& config, io::ResultFolder& folder)
    : folder_(folder.scratch(name)), crs_(config.output.crs.empty() ? config.geometry.crs : config.output.crs) {
  SurveyConfig described = config;
  if (described.title.empty()) described.title = folder.target().filename().string();
  settings_json_ = config_json([&](ConfigVisitor& v) { describe(v, described); });
}

void PartialSurvey::read(const SurveyInput& input) {
  json landmarks = json::array();
  for (const auto& l : input.landmarks.samples) {
    landmarks.push_back({l.position.latitude / units::deg, l.position.longitude / units::deg});
  }
  recorded_json_ = json{{"fixes", places(input.gnss.samples)}, {"landmarks", landmarks}}.dump();
  checked_ = input.record;
  track_.scale = input.imu.series.scale;
  track_.origin = "aided INS, forward";
}

void PartialSurvey::forward(const geodesy::TrajectoryPoint& now, const fusion::AidedInsResult& so_far) {
  // Control checks run the filter again over the same time.
  if (!track_.empty() && now.time <= track_.back().time) return;
  track_.samples.push_back(now);
  if (Clock::now() >= next_) publish("forward pass", track_, so_far);
}

void PartialSurvey::solved(const fusion::AidedInsResult& estimate) {
  const fusion::Solution& s = estimate.solution;
  if (!s.smoothed.empty()) publish("smoothed", s.smoothed, estimate);
}

std::string PartialSurvey::results_json(const char* stage, const geodesy::Trajectory& track,
                                        const fusion::AidedInsResult& found) const {
  json out{{"partial", stage}, {"length_m", length_of(track)}, {"crs", projection_->definition()}};
  std::map<std::string, std::pair<int, int>> counts;  // used, rejected
  for (const auto& i : found.solution.innovations) ++(i.used ? counts[i.sensor].first : counts[i.sensor].second);
  for (const auto& s : found.segments) out["segments"].push_back({{"alignment", s.alignment.method}});
  out["sensors"] = json::array();
  for (const auto& [sensor, n] : counts) {
    out["sensors"].push_back({{"sensor", sensor}, {"used", n.first}, {"rejected", n.second}});
  }
  out["standstills"] = json::parse(standstills_json(found.standstills, track.front().time));
  out["recorded"] = json::parse(recorded_json_);
  return out.dump();
}

void PartialSurvey::publish(const char* stage, const geodesy::Trajectory& track, const fusion::AidedInsResult& found) {
  if (track.size() < 3) return;
  const auto started = Clock::now();
  if (!projection_) {
    auto made = crs_.empty() ? geodesy::Projection::utm(track.front().position) : geodesy::Projection::create(crs_);
    if (!made) return;
    projection_ = std::move(*made);
  }
  const fs::path folder = folder_ / std::to_string(++number_);
  std::error_code code;
  fs::create_directories(folder, code);
  std::vector<fusion::Innovation> landmarks;
  for (const auto& i : found.solution.innovations) {
    if (i.sensor == "landmark") landmarks.push_back(i);
  }
  io::TrajectoryOutput output{.projection = &*projection_};
  output.interval = Duration::from_seconds((track.back().time - track.front().time).seconds() / most_points);
  io::Run run{.command = "survey", .version = version()};
  run.time_scale = track.scale;
  run.settings_json = settings_json_;
  run.results_json = results_json(stage, track, found);
  run.record = checked_;
  run.record.append(found.solution.record);
  const fs::path part = folder / ".run.json";
  const bool written = io::write_trajectory_csv(folder / "trajectory.csv", track, output) &&
                       io::write_innovations_csv(folder / "innovations.csv", landmarks, track.scale) &&
                       io::write_run_json(part, run);
  if (written) fs::rename(part, folder / "run.json", code);
  fs::remove_all(folder_ / std::to_string(number_ - 2), code);
  const auto now = Clock::now();
  next_ = now + std::max<Clock::duration>(least_wait, 50 * (now - started));
}

std::optional<fs::path> newest_partial(const fs::path& folder) {
  std::optional<fs::path> newest;
  int best = 0;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder / PartialSurvey::name, code)) {
    const std::string file = entry.path().filename().string();
    int number = 0;
    std::from_chars(file.data(), file.data() + file.size(), number);
    if (number <= best || !fs::exists(entry.path() / "run.json", code)) continue;
    best = number;
    newest = entry.path();
  }
  return newest;
}

}  // namespace versine::app
