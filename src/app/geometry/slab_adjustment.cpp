// SPDX-License-Identifier: Apache-2.0
#include "versine/app/slab_adjustment.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace versine::app {

Expected<io::FasteningPlans> plan_slab(const FasteningConfig& config, const track::Geometry& geometry,
                                       const track::Geometry* at_sleepers) {
  if (geometry.find("deviation_lateral_left") == nullptr) {
    return fail({.field = "geometry.fastenings",
                 .found = "no deviations from design",
                 .expected = "a design that fastenings are adjusted to",
                 .advice = "name geometry.design, or set fit_axis = true"});
  }
  io::FasteningPlans out;
  if (at_sleepers != nullptr) {
    out.at = *at_sleepers;
  } else {
    std::vector<double> at;
    for (double s = geometry.mileage.front(); s <= geometry.mileage.back(); s += config.spacing) at.push_back(s);
    out.at = track::sampled_at(geometry, at);
  }
  const std::size_t first = config.reference == FasteningConfig::Reference::left ? 0 : 1;
  const auto plan = [&](const char* direction, const track::FasteningOptions& options,
                        std::array<track::FasteningPlan, 2>& plans) -> Expected<void> {
    for (const std::size_t rail : {first, 1 - first}) {
      const track::Column* c = out.at.find(std::string("deviation_") + direction + (rail == 0 ? "_left" : "_right"));
      if (c == nullptr) return {};
      const std::span<const double> other =
          rail == first ? std::span<const double>() : std::span<const double>(plans[first].after);
      auto p = track::plan_fastenings(out.at.mileage, c->value, options, other);
      if (!p) return tl::unexpected(p.error());
      plans[rail] = std::move(*p);
    }
    return {};
  };
  if (auto done = plan("lateral", config.lateral, out.lateral); !done) return tl::unexpected(done.error());
  if (auto done = plan("vertical", config.vertical, out.vertical); !done) return tl::unexpected(done.error());
  return out;
}

std::string slab_json(const io::FasteningPlans& p) {
  nlohmann::ordered_json out{{"fastenings", p.at.size()}};
  const auto add = [&](const char* name, const track::FasteningPlan& plan) {
    if (!plan.steps.empty()) {
      out[name] = {{"moved", plan.moved},
                   {"unreachable", plan.unreachable},
                   {"windows", plan.windows},
                   {"windows_proven", plan.proven},
                   {"gap", plan.gap}};
    }
  };
  add("lateral_left", p.lateral[0]);
  add("lateral_right", p.lateral[1]);
  add("vertical_left", p.vertical[0]);
  add("vertical_right", p.vertical[1]);
  return out.dump();
}

std::string slab_text(const io::FasteningPlans& p) {
  const std::size_t unmet =
      p.lateral[0].unreachable + p.lateral[1].unreachable + p.vertical[0].unreachable + p.vertical[1].unreachable;
  std::size_t windows = 0, proven = 0;
  for (const auto* plans : {&p.lateral, &p.vertical}) {
    for (const track::FasteningPlan& plan : *plans) windows += plan.windows, proven += plan.proven;
  }
  return fmt::format(
      "  fastenings: {} of {} moved laterally (left {}, right {}), vertically left {}, right {}; {} of {} "
      "windows proven best{}\n",
      p.lateral[0].moved + p.lateral[1].moved, 2 * p.at.size(), p.lateral[0].moved, p.lateral[1].moved,
      p.vertical[0].moved, p.vertical[1].moved, proven, windows,
      unmet > 0 ? fmt::format("; {} limits cannot be met", unmet) : "");
}

}  // namespace versine::app
