// SPDX-License-Identifier: Apache-2.0
#include "network_model.hpp"

#include <fmt/format.h>

#include <cmath>

namespace versine::stationing {
namespace {

class Builder {
 public:
  Builder(const ControlNetwork& control, const NetworkOptions& options) : control_(control), options_(options) {}

  Expected<NetworkModel> build(std::span<const ReducedStation> stations) {
    for (const ReducedStation& s : stations) add(s);
    placed_.resize(model_.names.size());
    bool any = false;
    for (std::size_t i = 0; i < model_.names.size(); ++i) {
      if (model_.control[i] == nullptr) continue;
      model_.positions[i] = model_.control[i]->position;
      placed_[i] = any = true;
    }
    // Nothing known: the first station is the origin, its circle's zero is north.
    if (!any && !model_.stations.empty()) placed_[model_.stations[0].mark] = true, place(model_.stations[0], {});
    while (place_best()) {
    }
    for (const NetworkStation& s : model_.stations) {
      if (!s.placed) {
        return fail({.field = fmt::format("station {}", s.readings->name),
                     .found = "a station that too few common points join to the rest of the network",
                     .expected = options_.tilt_sigma ? "two common points or more" : "three common points or more",
                     .advice = "are the point numbers right? Otherwise adjust this part of the network by itself"});
      }
    }
    return std::move(model_);
  }

 private:
  std::size_t point(const std::string& name, bool mark_of_its_own) {
    const std::string key = mark_of_its_own ? "\n" + name : name;  // cannot collide with a point's number
    const auto [it, fresh] = index_.try_emplace(key, model_.names.size());
    if (fresh) {
      model_.names.push_back(name);
      model_.positions.push_back(Eigen::Vector3d::Zero());
      const ControlPoint* c = mark_of_its_own ? nullptr : control_.find(name);
      model_.control.push_back(c);
      model_.held.push_back(c != nullptr && !options_.free);
    }
    return it->second;
  }

  void add(const ReducedStation& s) {
    const std::size_t mark = s.mark.empty() ? point(s.name, true) : point(s.mark, false);
    const std::size_t station = model_.stations.size();
    model_.stations.push_back({&s, mark, s.instrument_height});
    by_station_.emplace_back();
    for (const Target& t : s.targets) {
      if (std::isnan(t.distance) || t.point.empty()) continue;
      by_station_[station].push_back(model_.sightings.size());
      model_.sightings.push_back({station, point(t.point, false), &t});
    }
  }

  std::vector<Pair> known_pairs(std::size_t station) const {
    const NetworkStation& s = model_.stations[station];
    std::vector<Pair> pairs;
    if (placed_[s.mark]) pairs.push_back({{0.0, 0.0, s.height}, model_.positions[s.mark]});
    for (const std::size_t k : by_station_[station]) {
      const NetworkSighting& o = model_.sightings[k];
      if (!placed_[o.point]) continue;
      const Eigen::Vector3d& x = model_.positions[o.point];
      pairs.push_back({local_vector(*o.target), x + o.target->target_height * up_at(x)});
    }
    return pairs;
  }

  /// The station with the most known points is next; false when none can be placed.
  bool place_best() {
    std::size_t best = 0, most = 0;
    std::optional<Consensus> pose;
    for (std::size_t i = 0; i < model_.stations.size(); ++i) {
      if (model_.stations[i].placed) continue;
      const auto pairs = known_pairs(i);
      if (pairs.size() <= most) continue;
      if (auto c = find_consensus(pairs, 0.3, 0.35, options_.tilt_sigma.has_value())) {
        best = i, most = pairs.size(), pose = std::move(c);
      }
    }
    if (pose) place(model_.stations[best], pose->pose);
    return pose.has_value();
  }

  void place(NetworkStation& s, const Pose& pose) {
    s.q_ms = pose.q_ms;
    s.placed = true;
    if (!placed_[s.mark]) {
      model_.positions[s.mark] = pose.position - s.height * up_at(pose.position);
      placed_[s.mark] = true;
    }
    const Eigen::Vector3d centre = model_.positions[s.mark] + s.height * up_at(model_.positions[s.mark]);
    for (const std::size_t k : by_station_[static_cast<std::size_t>(&s - model_.stations.data())]) {
      const NetworkSighting& o = model_.sightings[k];
      if (placed_[o.point]) continue;
      const Eigen::Vector3d seen = centre + s.q_ms * local_vector(*o.target);
      model_.positions[o.point] = seen - o.target->target_height * up_at(seen);
      placed_[o.point] = true;
    }
  }

  const ControlNetwork& control_;
  const NetworkOptions& options_;
  NetworkModel model_;
  std::unordered_map<std::string, std::size_t> index_;
  std::vector<std::vector<std::size_t>> by_station_;
  std::vector<bool> placed_;
};

}  // namespace

Eigen::Vector3d local_vector(const Target& t) {
  const double s = std::sin(t.zenith);
  return t.distance * Eigen::Vector3d(s * std::cos(t.direction), s * std::sin(t.direction), -std::cos(t.zenith));
}

Expected<NetworkModel> build_network(std::span<const ReducedStation> stations, const ControlNetwork& control,
                                     const NetworkOptions& options) {
  return Builder(control, options).build(stations);
}

}  // namespace versine::stationing
