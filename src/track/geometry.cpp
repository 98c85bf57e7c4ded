// SPDX-License-Identifier: Apache-2.0
#include "versine/track/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace versine::track {

std::string Column::heading() const {
  if (unit.empty()) return name;
  std::string shown;
  for (const char c : unit) shown += c == '/' ? std::string("_per_") : std::string(1, c);
  if (shown.starts_with("1_")) shown.erase(0, 2);
  return name + "_" + shown;
}

const Column* Geometry::find(std::string_view name) const {
  const auto it = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  return it == columns.end() ? nullptr : &*it;
}

Column* Geometry::find(std::string_view name) {
  return const_cast<Column*>(static_cast<const Geometry*>(this)->find(name));
}

const Column& Geometry::at(std::string_view name) const {
  const Column* column = find(name);
  if (column == nullptr) throw std::out_of_range("Geometry: no column '" + std::string(name) + "'");
  return *column;
}

Column& Geometry::add(std::string name, std::string unit, double scale, std::string description, bool with_sigma) {
  Column& column = columns.emplace_back();
  column.name = std::move(name);
  column.unit = std::move(unit);
  column.scale = scale;
  column.description = std::move(description);
  column.value.assign(size(), std::numeric_limits<double>::quiet_NaN());
  if (with_sigma) column.sigma.assign(size(), std::numeric_limits<float>::quiet_NaN());
  return column;
}

double Geometry::posted_at(double continuous) const {
  const auto it = std::upper_bound(posted.begin(), posted.end(), continuous,
                                   [](double s, const PostedMileage& p) { return s < p.start; });
  if (posted.empty()) return continuous;
  const PostedMileage& piece = it == posted.begin() ? posted.front() : *std::prev(it);
  return piece.posted_start + (piece.increasing ? 1.0 : -1.0) * (continuous - piece.start);
}

std::size_t Geometry::index_at(double continuous) const {
  const auto it = std::lower_bound(mileage.begin(), mileage.end(), continuous);
  if (it == mileage.begin()) return 0;
  if (it == mileage.end()) return size() - 1;
  const auto i = static_cast<std::size_t>(it - mileage.begin());
  return continuous - mileage[i - 1] < mileage[i] - continuous ? i - 1 : i;
}

Geometry sampled_at(const Geometry& g, const std::vector<double>& mileages) {
  Geometry out;
  out.step = 0.0;
  out.time_scale = g.time_scale;
  out.sleepers = g.sleepers;
  out.posted = g.posted;
  out.crs = g.crs;
  out.height_datum = g.height_datum;
  out.origin = g.origin;
  out.conventions = g.conventions;
  std::vector<std::size_t> left;
  std::vector<double> part;
  for (const double s : mileages) {
    if (g.size() < 2 || !(s >= g.mileage.front()) || !(s <= g.mileage.back())) continue;
    const auto it = std::upper_bound(g.mileage.begin(), g.mileage.end(), s);
    const auto i = std::min(static_cast<std::size_t>(it - g.mileage.begin()), g.size() - 1) - 1;
    const double t = (s - g.mileage[i]) / (g.mileage[i + 1] - g.mileage[i]);
    left.push_back(i);
    part.push_back(t);
    out.mileage.push_back(s);
    const Duration dt = g.time[i + 1] - g.time[i];
    out.time.push_back(g.time[i] + Duration{std::llround(t * static_cast<double>(dt.ns))});
    out.flags.push_back(g.flags[i] | g.flags[i + 1]);
  }
  for (const Column& c : g.columns) {
    Column& o = out.add(c.name, c.unit, c.scale, c.description, !c.sigma.empty());
    for (std::size_t k = 0; k < left.size(); ++k) {
      const std::size_t i = left[k];
      o.value[k] = c.value[i] + part[k] * (c.value[i + 1] - c.value[i]);
      if (!c.sigma.empty()) o.sigma[k] = std::max(c.sigma[i], c.sigma[i + 1]);
    }
  }
  return out;
}

}  // namespace versine::track
