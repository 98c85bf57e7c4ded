// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "versine/simulation/noise.hpp"
#include "versine/simulation/world.hpp"

namespace versine::simulation {

Series<sensors::OdometerSample> observe_odometer(const World& world, const OdometerModel& model, std::size_t index,
                                                 std::uint64_t seed, Truth& truth) {
  const std::string name = "odometer." + std::to_string(index);
  RandomStream constant(seed, name + ".constant"), random(seed, name);
  const double scale = model.scale_value.value_or(model.scale * constant.normal());
  truth.constants.emplace_back("odometer_" + std::to_string(index) + "_scale", scale);
  const double mean_way = 1000.0 / model.slip_per_km;  // infinite without slip
  double next_slip = model.slip_per_km > 0.0 ? random.exponential(mean_way) : 1e300;

  Series<sensors::OdometerSample> series;
  series.scale = world.time_scale;
  // Pulses are found on a fine grid of time and placed inside it by interpolation.
  const bool pulses = model.output == OdometerModel::Output::pulses;
  const double rate = pulses ? std::max(1000.0, model.rate) : model.rate;
  const auto count = static_cast<std::size_t>(world.duration * rate);
  const Eigen::Index row = model.wheel == OdometerModel::Wheel::a1 ? 0 : 1;
  double told = 0.0, way = 0.0, walk = 0.0, before = 0.0, counted = 0.0;
  const Piece* piece = nullptr;
  for (std::size_t k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / rate;
    const Piece& here = world.piece_at(t);
    const double wheel = here.body.wheels(here.motion.at(t - here.begin).distance)(row);
    if (&here != piece) before = wheel, piece = &here;  // a new piece counts from elsewhere
    const double step = wheel - before;
    before = wheel;
    way += std::abs(step);
    if (model.scale_walk > 0.0 && step != 0.0) walk += model.scale_walk * std::sqrt(std::abs(step)) * random.normal();
    const double told_before = told;
    told += (1.0 + scale + walk) * step;
    while (way > next_slip) {
      told += model.slip_distance * random.normal();
      next_slip += random.exponential(mean_way);
    }
    if (pulses) {
      // The counter changes when the wheel has turned a whole step further, in either direction.
      while (std::abs(told - counted) >= model.quantum) {
        counted += std::copysign(model.quantum, told - counted);
        const double share = told == told_before ? 1.0 : (counted - told_before) / (told - told_before);
        series.samples.push_back({world.time(t - (1.0 - std::clamp(share, 0.0, 1.0)) / rate), counted});
      }
    } else {
      const double out = model.quantum > 0.0 ? std::floor(told / model.quantum) * model.quantum : told;
      series.samples.push_back({world.time(t), out});
    }
  }
  return series;
}

Series<sensors::GaugeSample> observe_gauge(const World& world, const GaugeModel& model, std::uint64_t seed,
                                           Truth& truth) {
  RandomStream constant(seed, "gauge.constant"), random(seed, "gauge");
  const double offset = model.offset_error * constant.normal();
  truth.constants.emplace_back("gauge_offset_error", offset);
  Series<sensors::GaugeSample> series;
  series.scale = world.time_scale;
  const auto count = static_cast<std::size_t>(world.duration * model.rate);
  double before = world.motion(0.0).distance;
  for (std::size_t k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / model.rate;
    const Piece& piece = world.piece_at(t);
    const double distance = piece.motion.at(t - piece.begin).distance;
    // Chen eq. 1, solved for what the sensor sees; its curve correction (eq. 2) is in the contact points.
    const double warmth = world.equipment.temperature.at(t);
    double reading = piece.body.wheels(distance)(2) - world.trolley.gauge_offset -
                     world.trolley.gauge_temperature_factor * warmth + offset + model.noise * random.normal();
    if (model.joint_spacing > 0.0 &&
        std::floor(distance / model.joint_spacing) != std::floor(before / model.joint_spacing)) {
      reading += model.joint_spike * random.normal();
    }
    before = distance;
    series.samples.push_back({world.time(t), reading, warmth});
  }
  return series;
}

Series<sensors::RangeSample> observe_sleepers(const World& world, const SleeperModel& model, std::uint64_t seed) {
  RandomStream random(seed, "sleeper"), which(seed, "sleeper.which");
  // Drawn once for each sleeper: a second pass misses the same ones and sees the same stones.
  std::vector<double> seen;
  for (const double s : world.sleepers) {
    if (!which.chance(model.missed)) seen.push_back(s);
  }
  if (model.false_per_km > 0.0 && !world.sleepers.empty()) {
    for (double s = world.sleepers.front(); s < world.sleepers.back();) {
      s += which.exponential(1000.0 / model.false_per_km);
      seen.push_back(s);
    }
    std::sort(seen.begin(), seen.end());
  }
  Series<sensors::RangeSample> series;
  series.scale = world.time_scale;
  const auto count = static_cast<std::size_t>(world.duration * model.rate);
  for (std::size_t k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / model.rate;
    const Piece& piece = world.piece_at(t);
    const double at = piece.motion.at(t - piece.begin).distance +
                      piece.body.forward() * (world.trolley.range_x - world.trolley.other_x);
    const auto next = std::lower_bound(seen.begin(), seen.end(), at - 0.5 * model.width);
    const bool above = next != seen.end() && std::abs(*next - at) <= 0.5 * model.width;
    series.samples.push_back(
        {world.time(t), model.range - (above ? model.height : 0.0) + model.noise * random.normal()});
  }
  return series;
}

}  // namespace versine::simulation
