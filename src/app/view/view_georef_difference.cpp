// SPDX-License-Identifier: Apache-2.0
#include "view_georef_difference.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace versine::app {

using json = nlohmann::ordered_json;

namespace {

/// The journey of the same recording that shares most time.
const json* same_journey(const json& journey, const json& others) {
  const json* best = nullptr;
  double most = 0.0;
  for (const json& o : others) {
    if (o["recording"] != journey["recording"] || o["hypotheses"].empty()) continue;
    const double shared = std::min(o["to"].get<double>(), journey["to"].get<double>()) -
                          std::max(o["from"].get<double>(), journey["from"].get<double>());
    if (shared > most) {
      most = shared;
      best = &o;
    }
  }
  return best;
}

struct Run {
  double from = 0.0, to = 0.0;  ///< m on the path
  std::vector<std::string> tracks;
};

/// Tracks of a path that the other has not, as runs behind the last track that both have ("" at the start).
std::map<std::string, Run> own_runs(const json& tracks, const std::set<std::string>& common, double from) {
  std::map<std::string, Run> out;
  std::string anchor;
  double end = from;
  for (const json& t : tracks) {
    const auto id = t["id"].get<std::string>();
    if (common.contains(id)) {
      anchor = id;
      end = t["to"].get<double>();
      out.try_emplace(anchor, Run{end, end, {}});
      continue;
    }
    Run& run = out.try_emplace(anchor, Run{end, end, {}}).first->second;
    run.to = t["to"].get<double>();
    run.tracks.push_back(id);
  }
  return out;
}

json differences(const json& mine, const json& other) {
  const auto ids = [](const json& path) {
    std::set<std::string> out;
    for (const json& t : path["tracks"]) out.insert(t["id"].get<std::string>());
    return out;
  };
  const auto a = ids(mine), b = ids(other);
  std::set<std::string> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(common, common.end()));
  const auto here = own_runs(mine["tracks"], common, mine["from"].get<double>());
  auto there = own_runs(other["tracks"], common, other["from"].get<double>());
  json out = json::array();
  for (const auto& [anchor, run] : here) {
    const auto& instead = there[anchor].tracks;
    if (run.tracks.empty() && instead.empty()) continue;
    out.push_back({{"fromM", run.from}, {"toM", run.to}, {"here", run.tracks}, {"there", instead}});
  }
  std::sort(out.begin(), out.end(), [](const json& x, const json& y) { return x["fromM"] < y["fromM"]; });
  return out;
}

}  // namespace

void add_difference(json& journeys, const json& others) {
  for (json& journey : journeys) {
    const json* other = journey["hypotheses"].empty() ? nullptr : same_journey(journey, others);
    journey["other"] = other == nullptr ? json(nullptr) : (*other)["hypotheses"][0];
    journey["differs"] =
        other == nullptr ? json::array() : differences(journey["hypotheses"][0], (*other)["hypotheses"][0]);
  }
}

}  // namespace versine::app
