// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/planning_search.hpp"

#include <cmath>

namespace versine::fusion {

namespace {

constexpr double shortest = 1.0, longest = 5000.0;  // m

/// Largest x in [low, high] that keeps `good(x)`, for a `good` that holds below some x only; none when not at `low`.
/// Bisection of the logarithm.
template <class Good>
std::optional<double> largest(double low, double high, double relative, const Good& good) {
  if (!good(low)) return std::nullopt;
  if (good(high)) return high;
  while (high / low > 1.0 + relative) {
    const double middle = std::sqrt(low * high);
    (good(middle) ? low : high) = middle;
  }
  return low;
}

template <class Sigma>
SigmaMap make_map(double largest_x, double largest_y, int points, const Sigma& sigma) {
  SigmaMap map;
  for (int i = 0; i < points; ++i) {
    map.x.push_back(largest_x * i / (points - 1));
    map.y.push_back(largest_y * i / (points - 1));
  }
  for (const double y : map.y) {
    for (const double x : map.x) map.sigma.push_back(sigma(x, y));
  }
  return map;
}

double middle_cross(const CrossErrors& e, const PlanCase& plan) {
  const double T = plan.spacing / plan.speed;
  return std::sqrt(cross_variance(e, plan.speed, T, 0.5 * T));
}

}  // namespace

double worst_sigma(const PlanCase& plan, PlanBasis basis) {
  return basis == PlanBasis::interval ? closed_form_worst(plan).worst_cross()
                                      : chain_accuracy(plan, 0.0).worst_interior.worst_cross();
}

std::optional<double> largest_spacing(PlanCase plan, double required, PlanBasis basis) {
  const auto good = [&](double spacing) {
    plan.spacing = spacing;
    return worst_sigma(plan, basis) <= required;
  };
  const auto found = largest(shortest, longest, 1e-4, good);
  return found ? std::optional(std::floor(*found * 10.0) / 10.0) : std::nullopt;
}

std::optional<double> largest_random_walk(PlanCase plan, double required, PlanBasis basis) {
  return largest(1e-9, 1e-2, 1e-4, [&](double walk) {
    plan.gyro.random_walk = walk;
    return worst_sigma(plan, basis) <= required;
  });
}

std::optional<double> largest_bias(PlanCase plan, double required, PlanBasis basis) {
  return largest(1e-10, 1e-3, 1e-4, [&](double bias) {
    plan.gyro.bias = bias;
    return worst_sigma(plan, basis) <= required;
  });
}

std::vector<GradeVerdict> judge_grades(const PlanCase& plan, double required, PlanBasis basis) {
  std::vector<GradeVerdict> verdicts;
  for (const auto& grade : sensors::imu_grades()) {
    if (!(grade.errors.gyro.random_walk > 0.0)) continue;
    PlanCase other = plan;
    other.gyro = grade.errors.gyro;
    verdicts.push_back({std::string(grade.name), worst_sigma(other, basis), largest_spacing(other, required, basis)});
  }
  return verdicts;
}

SigmaMap lateral_map(const PlanCase& plan, double largest_bias, double largest_walk, int points) {
  CrossErrors e = derive(plan).lateral;
  return make_map(largest_bias, largest_walk, points, [&](double bias, double walk) {
    e.angle = gyrocompass_heading_error(bias, plan.latitude);
    e.bias = bias;
    e.random_walk = walk;
    return middle_cross(e, plan);
  });
}

SigmaMap vertical_map(const PlanCase& plan, double largest_bias, double largest_walk, int points) {
  CrossErrors e = derive(plan).vertical;
  return make_map(largest_bias, largest_walk, points, [&](double bias, double walk) {
    e.bias = bias;
    e.random_walk = walk;
    return middle_cross(e, plan);
  });
}

SigmaMap longitudinal_map(const PlanCase& plan, double largest_scale, double largest_walk, int points) {
  LongitudinalErrors e = derive(plan).longitudinal;
  const double T = plan.spacing / plan.speed;
  return make_map(largest_scale, largest_walk, points, [&](double scale, double walk) {
    e.scale = scale;
    e.scale_walk = walk;
    return std::sqrt(longitudinal_variance(e, plan.speed, T, 0.5 * T));
  });
}

}  // namespace versine::fusion
