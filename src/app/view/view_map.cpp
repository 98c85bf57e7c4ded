// SPDX-License-Identifier: Apache-2.0
#include "view_map.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <cstdint>
#include <limits>
#include <thread>

#include "versine/io/network_file.hpp"

namespace versine::app {

namespace {

using Line = std::vector<Eigen::Vector2d>;

template <class T>
void put(std::string& out, const T* data, std::size_t count) {
  out.append(reinterpret_cast<const char*>(data), count * sizeof(T));
}

Line simplified(const Line& line, double tolerance) {
  namespace bg = boost::geometry;
  using Point = bg::model::d2::point_xy<double>;
  bg::model::linestring<Point> fine, coarse;
  fine.reserve(line.size());
  for (const auto& p : line) fine.emplace_back(p.x(), p.y());
  bg::simplify(fine, coarse, tolerance);
  Line out;
  out.reserve(coarse.size());
  for (const auto& p : coarse) out.emplace_back(p.x(), p.y());
  return out;
}

std::array<double, 4> bounds_of(const std::vector<Line>& lines) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 4> b{infinity, infinity, -infinity, -infinity};
  for (const Line& line : lines) {
    for (const auto& p : line) {
      b = {std::min(b[0], p.x()), std::min(b[1], p.y()), std::max(b[2], p.x()), std::max(b[3], p.y())};
    }
  }
  return b[0] <= b[2] ? b : std::array<double, 4>{};
}

}  // namespace

std::string encode_points(const std::vector<Line>& groups) {
  const auto b = bounds_of(groups);
  const Eigen::Vector2d origin(0.5 * (b[0] + b[2]), 0.5 * (b[1] + b[3]));
  std::vector<std::uint32_t> start{0};
  std::vector<float> places;
  for (const Line& group : groups) {
    for (const auto& p : group) {
      places.push_back(static_cast<float>(p.x() - origin.x()));
      places.push_back(static_cast<float>(p.y() - origin.y()));
    }
    start.push_back(static_cast<std::uint32_t>(places.size() / 2));
  }
  std::string out;
  const std::uint32_t counts[2] = {static_cast<std::uint32_t>(groups.size()), start.back()};
  put(out, origin.data(), 2);
  put(out, counts, 2);
  put(out, start.data(), start.size());
  put(out, places.data(), places.size());
  return out;
}

Expected<ViewNetwork> read_view_network(const std::filesystem::path& geojson, const geodesy::Projection& projection) {
  auto source = io::read_network({.path = geojson});
  if (!source) return tl::unexpected(source.error());
  ViewNetwork out;
  std::vector<Line> lines;
  lines.reserve(source->tracks.size());
  for (const auto& track : source->tracks) {
    Line line;
    line.reserve(track.points.size());
    for (const auto& p : track.points) {
      const auto map = projection.forward({p.y(), p.x(), 0.0});
      line.emplace_back(map.easting, map.northing);
    }
    lines.push_back(std::move(line));
    out.names.push_back(track.id);
  }
  out.bounds = bounds_of(lines);
  // The middle level and the coarse one on a thread each: the page waits for none of them.
  const auto level = [&](std::size_t index, double tolerance) {
    std::vector<Line> coarse;
    coarse.reserve(lines.size());
    for (const Line& line : lines) coarse.push_back(simplified(line, tolerance));
    out.levels[index] = encode_points(coarse);
  };
  std::thread middle(level, 1, 40.0);
  level(2, 200.0);
  out.levels[0] = encode_points(lines);
  middle.join();
  return out;
}

}  // namespace versine::app
