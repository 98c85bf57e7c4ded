// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "versine/georef/georeference.hpp"
#include "versine/io/journey_brussels.hpp"
#include "versine/io/network_labelled.hpp"
#include "versine/network/build.hpp"

/// The measuring train's logs around Brussels airport, and how well hidden fixes are found again.
namespace versine::test {

using georef::Recording;
using Ids = std::vector<std::string>;

inline Ids ids_of(const georef::Map& map, const georef::RecordingResult& r) {
  Ids ids;
  for (const auto& j : r.journeys) {
    for (const auto& t : j.paths.front().coordinates.path()) {
      const auto& id = map.network.tracks[t.track].line_id;
      if (ids.empty() || ids.back() != id) ids.push_back(id);
    }
  }
  return ids;
}

/// Map, logs and expected paths.
struct Fixture {
  std::filesystem::path folder;
  std::unique_ptr<georef::Map> map;
  std::map<std::string, Ids> expected;

  explicit Fixture(const std::filesystem::path& f) : folder(f) {
    auto network = network::build(*io::read_labelled_network(folder / "network_airport.geojson"));
    map = std::make_unique<georef::Map>(std::move(*network));
    std::ifstream stream(folder / "expected_paths.json");
    expected = nlohmann::json::parse(stream).get<std::map<std::string, Ids>>();
  }
  [[nodiscard]] Recording log(const std::string& name) const {
    return *io::read_brussels_log(folder / (name + ".csv"));
  }
};

/// Of hidden fixes, along the track.
struct Errors {
  double square = 0.0;
  std::size_t n = 0, inside = 0;
  double worst = 0.0;
  [[nodiscard]] double rms() const { return std::sqrt(square / static_cast<double>(n)); }
  [[nodiscard]] double coverage() const { return static_cast<double>(inside) / static_cast<double>(n); }
};

/// Fixes of ambiguity-fixed type within 3.5 m of the expected path.
inline std::vector<char> good_fixes(const Fixture& f, const Recording& r, const Ids& ids) {
  std::vector<char> good;
  for (const auto& fix : r.gnss) {
    const bool narrow = fix.type == sensors::FixType::fixed;
    bool near = false;
    if (narrow) {
      for (const auto& hit : f.map->index.near(f.map->network.to_map(fix.position), 3.5)) {
        near = near || std::find(ids.begin(), ids.end(), f.map->network.tracks[hit.track].line_id) != ids.end();
      }
    }
    good.push_back(narrow && near);
  }
  return good;
}

/// Hides windows of `seconds` that start every 1.5 windows inside runs of good fixes, and adds up the errors there.
inline bool hide(const Fixture& f, const Recording& whole, const Ids& ids, double seconds,
                 const georef::Options& options, Errors& out) {
  const auto good = good_fixes(f, whole, ids);
  std::vector<char> hidden(whole.gnss.size(), 0);
  const auto t = [&](std::size_t i) { return (whole.gnss[i].time - whole.gnss[0].time).seconds(); };
  for (std::size_t i = 0; i < good.size();) {
    std::size_t j = i;
    if (!good[i]) {
      ++i;
      continue;
    }
    while (j + 1 < good.size() && good[j + 1] && t(j + 1) - t(j) <= 1.0) ++j;
    for (double a = t(i) + 5.0; a + seconds + 5.0 <= t(j); a += 1.5 * seconds) {
      for (std::size_t k = i; k <= j; ++k) hidden[k] = hidden[k] || (t(k) >= a && t(k) < a + seconds);
    }
    i = j + 1;
  }
  Recording seen = whole;
  seen.gnss.samples.clear();
  for (std::size_t i = 0; i < good.size(); ++i) {
    if (!hidden[i]) seen.gnss.samples.push_back(whole.gnss[i]);
  }
  const auto result = georef::georeference(*f.map, seen, options);
  if (!result) return false;
  for (std::size_t i = 0; i < good.size(); ++i) {
    if (!hidden[i] || !good[i]) continue;
    const auto s = georef::stamp(*result, whole.gnss[i].time);
    if (!s.valid) continue;
    const auto& path = result->journeys[s.journey].paths.front().coordinates;
    const auto truth =
        path.project(f.map->network.to_map(whole.gnss[i].position), s.distance - 300.0, s.distance + 300.0);
    const double e = s.distance - truth.distance;
    out.square += e * e;
    ++out.n;
    out.inside += std::abs(e) <= 1.96 * std::hypot(s.sigma, 0.05);
    out.worst = std::max(out.worst, std::abs(e));
  }
  return true;
}

}  // namespace versine::test
