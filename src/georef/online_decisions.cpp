// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "online_bank.hpp"

namespace versine::georef {

void OnlineGeoreferencer::Bank::weigh(Time time) {
  double best = -INFINITY, sum = 0.0;
  for (const auto& h : alive_) best = std::max(best, h.log_weight());
  for (auto& h : alive_) {
    h.state.log_likelihood -= best;  // only differences matter; so the numbers stay small for ever
    sum += h.probability = std::exp(h.log_weight());
  }
  for (auto& h : alive_) h.probability /= sum;
  merge_equal();
  std::sort(alive_.begin(), alive_.end(), [](const auto& a, const auto& b) { return a.probability > b.probability; });
  std::erase_if(alive_, [&](const auto& h) { return h.probability < online_.prune; });
  if (alive_.size() > online_.hypotheses) alive_.resize(online_.hypotheses);
  for (auto& h : alive_) {
    const std::size_t at = h.at();
    for (std::size_t i = 0; i <= at; ++i) {
      Node& node = nodes_[static_cast<std::size_t>(h.nodes[i])];
      if (!node.entered) {
        const double since = (h.odometer() - node.odometer) / std::max(std::abs(h.state.x[1]), 0.1);
        node.entered = time - Duration::from_seconds(std::clamp(since, 0.0, last_ ? (time - *last_).seconds() : 0.0));
      }
    }
    cut_behind(h);
  }
  if (nodes_.size() > 20'000) collect_nodes();
}

/// Ways that met again long ago are one: what decided between them lies behind.
void OnlineGeoreferencer::Bank::merge_equal() {
  std::sort(alive_.begin(), alive_.end(), [](const auto& a, const auto& b) { return a.probability > b.probability; });
  for (std::size_t i = 0; i < alive_.size(); ++i) {
    for (std::size_t j = i + 1; j < alive_.size();) {
      const bool same = alive_[i].path->path() == alive_[j].path->path() &&
                        std::abs(alive_[i].state.x[0] - alive_[j].state.x[0]) < 5.0;
      if (!same) {
        ++j;
        continue;
      }
      alive_[i].prior += std::log1p(alive_[j].probability / alive_[i].probability);
      alive_[i].probability += alive_[j].probability;
      alive_.erase(alive_.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
}

void OnlineGeoreferencer::Bank::cut_behind(Hypothesis& h) {
  const auto& starts = h.path->starts();
  const double needed = h.state.x[0] - 5.0 * std::sqrt(h.state.P(0, 0)) - 300.0;
  std::size_t cut = 0;
  while (cut + 1 < h.path->path().size() && starts[cut + 1] < needed) ++cut;
  if (cut < 3 && starts[cut] < 3000.0) return;  // not for every track
  if (cut == 0) return;
  const double shift = starts[cut];
  const auto& tracks = h.path->path();
  h.path = std::make_shared<network::PathCoordinates>(
      map_.network, network::Path(tracks.begin() + static_cast<std::ptrdiff_t>(cut), tracks.end()));
  h.nodes.erase(h.nodes.begin(), h.nodes.begin() + static_cast<std::ptrdiff_t>(cut));
  h.state.x[0] -= shift;
  h.origin += shift;
}

/// The child of `ancestor` on the way from it to `node`; `node` itself where the ancestor is not above it.
int OnlineGeoreferencer::Bank::below(int node, int ancestor) const {
  while (node != none && nodes_[static_cast<std::size_t>(node)].parent != ancestor) {
    node = nodes_[static_cast<std::size_t>(node)].parent;
  }
  return node;
}

void OnlineGeoreferencer::Bank::decide(Time time) {
  while (true) {
    std::map<int, double> children;
    double through = 0.0;
    for (const auto& h : alive_) {
      const int node = h.nodes[h.at()];
      if (node == decided_) {
        through += h.probability;
      } else if (const int child = below(node, decided_); child != none) {
        children[child] += h.probability;
        through += h.probability;
      }
    }
    if (through < 1.0 - online_.decide && revise()) continue;
    const auto best = std::max_element(children.begin(), children.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    if (best == children.end() || best->second < online_.decide) return;
    decide_on(best->first, best->second, time);
  }
}

void OnlineGeoreferencer::Bank::decide_on(int id, double probability, Time time) {
  const Node& node = nodes_[static_cast<std::size_t>(id)];
  const network::OrientedTrack from =
      node.parent == none ? node.track : nodes_[static_cast<std::size_t>(node.parent)].track;
  const bool choice = node.kind != OnlineDecision::Kind::leg || map_.graph.successors(from).size() > 1;
  if (choice || revising_) {
    decisions.push_back({node.kind, from, node.track, node.entered.value_or(time), time,
                         std::max(0.0, alive_.front().odometer() - node.odometer), probability, revising_});
  }
  decided_ = id;
  revising_ = false;
}

/// What was decided has become improbable: back to where the present best way left it.
bool OnlineGeoreferencer::Bank::revise() {
  const int best = alive_.front().nodes[alive_.front().at()];
  for (int up = decided_; up != none; up = nodes_[static_cast<std::size_t>(up)].parent) {
    if (up != decided_ && (best == up || below(best, up) != none)) {
      decided_ = up;
      revising_ = true;
      return true;
    }
  }
  if (decided_ == none) return false;
  decided_ = none;
  revising_ = true;
  return true;
}

/// Drops tracks that no hypothesis came by since the last decision, so that memory does not grow with the journey.
void OnlineGeoreferencer::Bank::collect_nodes() {
  std::map<int, int> kept;
  if (decided_ != none) kept[decided_] = 0;
  for (const auto& h : alive_) {
    for (const int n : h.nodes) kept[n] = 0;
    for (int n = h.nodes.back(); n != none && n != decided_; n = nodes_[static_cast<std::size_t>(n)].parent)
      kept[n] = 0;
  }
  std::vector<Node> fresh;
  for (auto& [from, to] : kept) {  // parents have smaller numbers than their children
    to = static_cast<int>(fresh.size());
    Node node = nodes_[static_cast<std::size_t>(from)];
    const auto parent = kept.find(node.parent);
    node.parent = parent == kept.end() ? none : parent->second;
    fresh.push_back(node);
  }
  nodes_ = std::move(fresh);
  if (decided_ != none) decided_ = kept[decided_];
  for (auto& h : alive_) {
    for (int& n : h.nodes) n = kept[n];
  }
}

}  // namespace versine::georef
