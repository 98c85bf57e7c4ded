// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "versine/simulation/random.hpp"
#include "versine/simulation/world.hpp"

namespace versine::simulation {

namespace {
/// A blow on the wheel: a damped ringing that begins when the wheel is there.
void strike(std::vector<float>& out, double rate, double begin, double size, double frequency, double decay) {
  const auto first = static_cast<std::ptrdiff_t>(std::ceil(begin * rate));
  const auto last =
      std::min(static_cast<std::ptrdiff_t>(out.size()), first + static_cast<std::ptrdiff_t>(6 * decay * rate));
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, first); i < last; ++i) {
    const double t = static_cast<double>(i) / rate - begin;
    out[static_cast<std::size_t>(i)] +=
        static_cast<float>(size * std::exp(-t / decay) * std::sin(2.0 * std::numbers::pi * frequency * t));
  }
}
}  // namespace

AxleBoxRecording observe_axle_box(const World& world, const AxleBoxModel& model, std::uint64_t seed) {
  const bool all = !(model.recorded.to > model.recorded.from);
  const double from = all ? 0.0 : model.recorded.from;
  const double to = all ? world.duration : std::min(model.recorded.to, world.duration);
  AxleBoxRecording out{world.time(from), model.rate, {}};
  RandomStream random(seed, "axle_box");
  const auto count = static_cast<std::size_t>(std::max(0.0, to - from) * model.rate);
  out.vertical.resize(count);
  // Speed changes slowly against 20 kHz: taken every 5 ms.
  const auto every = static_cast<std::size_t>(std::max(1.0, model.rate * 0.005));
  double speed = 0.0, colour = 0.0, before = world.motion(from).distance;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % every == 0) {
      const double t = from + static_cast<double>(i) / model.rate;
      const MotionState m = world.motion(t);
      speed = std::abs(m.speed);
      const auto crossed = [&](double place) {
        return (place - before) * (place - m.distance) <= 0.0 && m.distance != before;
      };
      for (const double joint : model.joints) {
        if (!crossed(joint)) continue;
        const double back = std::abs(m.distance - joint) / std::max(speed, 0.01);
        strike(out.vertical, model.rate, t - from - back, model.joint_impact * speed, 900.0, 0.004);
      }
      for (const double nose : model.switches) {
        if (!crossed(nose)) continue;
        const double back = std::abs(m.distance - nose) / std::max(speed, 0.01);
        strike(out.vertical, model.rate, t - from - back, model.switch_impact * speed, 500.0, 0.008);
      }
      before = m.distance;
    }
    // Wheel and rail roughness through the contact's low pass.
    colour = 0.7 * colour + 0.714 * random.normal();
    out.vertical[i] += static_cast<float>(model.roughness * speed * colour);
  }
  return out;
}

}  // namespace versine::simulation
