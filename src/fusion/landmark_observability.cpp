// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_observability.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"

namespace versine::fusion::landmark {

namespace {

struct RankCondition {
  int rank = 0;
  double condition = 0.0;
};
RankCondition judge(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() == 0) return {};
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix);
  const auto& s = svd.singularValues();
  RankCondition r;
  for (Eigen::Index i = 0; i < s.size(); ++i) r.rank += s(i) > 1e-10 * s(0) ? 1 : 0;
  r.condition = s(s.size() - 1) > 0.0 && s.size() == matrix.cols() ? s(0) / s(s.size() - 1)
                                                                   : std::numeric_limits<double>::infinity();
  return r;
}

Eigen::VectorXd vertical_prior(const Prior& p) {
  return Eigen::Vector3d(p.position, p.pitch, p.bias);
}
Eigen::VectorXd level_prior(const Prior& p) {
  Eigen::VectorXd d(level::size);
  d << p.position, p.position, p.scale, p.heading, p.bias;
  return d;
}

/// Rows H Phi(k, 0) of the ties used, over landmark sigma, columns times prior sigma.
template <class Step>
Eigen::MatrixXd stacked(std::span<const Step> steps, std::span<const Tie> ties, std::span<const Fit> fits, int observed,
                        const Eigen::VectorXd& prior, int first) {
  constexpr int n = decltype(Step::transition)::RowsAtCompileTime;
  Eigen::MatrixXd rows(0, n);
  Eigen::Matrix<double, n, n> Phi = Eigen::Matrix<double, n, n>::Identity();
  std::size_t k = 0;
  for (std::size_t i = 0; i < ties.size(); ++i) {
    for (; k < ties[i].node;) Phi = (steps[++k].transition * Phi).eval();
    if (!fits[i].used) continue;
    const auto at = rows.rows();
    rows.conservativeResize(at + observed, n);
    for (int j = 0; j < observed; ++j) {
      rows.row(at + j) =
          Phi.row(j).cwiseProduct(prior.transpose()) / std::sqrt(ties[i].covariance(first + j, first + j));
    }
  }
  return rows;
}

std::string quantity(double sigma, const std::string& unit) {
  if (unit == "deg") return fmt::format("{:.4f} deg", sigma / units::deg);
  if (unit == "deg/h") return fmt::format("{:.4f} deg/h", sigma / units::deg_per_hour);
  if (unit == "ppm") return fmt::format("{:.0f} ppm", sigma / units::ppm);
  return fmt::format("{:.2f} mm", sigma / units::mm);
}

/// Largest sigma of a state, and where that is.
struct Weakest {
  double sigma = 0.0;
  std::size_t node = 0;
};
template <class Epochs>
Weakest weakest(const Epochs& epochs, int state) {
  double P = 0.0;
  std::size_t node = 0;
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    const double here = epochs[k].estimate.covariance(state, state);
    if (here > P) P = here, node = k;
  }
  return {std::sqrt(P), node};
}

void add_states(Observability& o, std::span<const double> distance, const Prior& prior, const Smoothed& s) {
  const struct {
    const char* name;
    const char* unit;
    double before;
    Weakest after;
  } rows[] = {{"pitch of the trolley", "deg", prior.pitch, weakest(s.vertical, vertical::pitch)},
              {"bias of the lateral gyro", "deg/h", prior.bias, weakest(s.vertical, vertical::bias)},
              {"odometer scale", "ppm", prior.scale, weakest(s.level, level::scale)},
              {"heading of the trolley", "deg", prior.heading, weakest(s.level, level::heading)},
              {"bias of the vertical gyro", "deg/h", prior.bias, weakest(s.level, level::bias)}};
  for (const auto& row : rows) {
    const double at = distance[row.after.node];
    o.states.push_back({row.name, row.before, row.after.sigma, row.before / row.after.sigma, at});
    if (row.before < 2.0 * row.after.sigma) {
      o.verdict.push_back(
          fmt::format("{}: weak; {} before the run, {} at worst in it, {:.0f} m from the start. The landmarks say "
                      "little about it; its value rests on what was given.",
                      row.name, quantity(row.before, row.unit), quantity(row.after.sigma, row.unit), at));
    }
  }
}

/// The place of the largest position sigma, in words.
void add_weakest_place(Observability& o, std::span<const double> distance, std::span<const Tie> ties,
                       std::span<const Fit> fits, const Smoothed& s) {
  double worst = 0.0;
  std::size_t worst_node = 0;
  for (std::size_t k = 0; k < distance.size(); ++k) {
    const double sigma = std::sqrt(std::max(s.vertical[k].estimate.covariance(0, 0),
                                            s.level[k].estimate.covariance.topLeftCorner<2, 2>().trace()));
    if (sigma > worst) worst = sigma, worst_node = k;
  }
  std::size_t first = distance.size(), last = 0;
  for (std::size_t i = 0; i < ties.size(); ++i) {
    if (!fits[i].used) continue;
    first = std::min(first, ties[i].node);
    last = std::max(last, ties[i].node);
  }
  constexpr double near = 1.0;  // m
  const double at = distance[worst_node], begin = distance[first], end = distance[last];
  const char* where = begin - at > near ? "before the first landmark: nothing holds that end"
                      : at - end > near ? "beyond the last landmark: nothing holds that end"
                      : at - begin < near || end - at < near
                          ? "at an outermost landmark, which has a neighbour on one side only"
                          : "between two landmarks";
  o.verdict.push_back(
      fmt::format("position is weakest {:.1f} m from the start ({:.2f} mm), {}.", at, worst / units::mm, where));
}

}  // namespace

Observability observability_at(double speed, double heading, double interval, const Prior& prior,
                               double landmark_sigma) {
  // Eq. 26: H, H A, H A^2; derivatives in units of the interval. Transitions hold A: Phi(dt) - I = A dt + A^2 dt^2/2.
  Eigen::Matrix3d Av = Eigen::Matrix3d::Zero();
  Av(vertical::position, vertical::pitch) = speed;
  Av(vertical::pitch, vertical::bias) = -1.0;
  Eigen::Matrix<double, 5, 5> Al = Eigen::Matrix<double, 5, 5>::Zero();
  const double c = speed * std::cos(heading), s = speed * std::sin(heading);
  Al(level::north, level::scale) = c;
  Al(level::north, level::heading) = s;
  Al(level::east, level::scale) = s;
  Al(level::east, level::heading) = -c;
  Al(level::heading, level::bias) = -1.0;
  const auto matrix = [&](const Eigen::MatrixXd& A, int observed, const Eigen::VectorXd& d) {
    Eigen::MatrixXd O(observed * A.rows(), A.cols()), power = Eigen::MatrixXd::Identity(A.rows(), A.cols());
    for (Eigen::Index k = 0; k < A.rows(); ++k) {
      O.middleRows(k * observed, observed) = power.topRows(observed) * d.asDiagonal() / landmark_sigma;
      power = (power * A * interval / static_cast<double>(k + 1)).eval();
    }
    return O;
  };
  Observability o;
  const auto v = judge(matrix(Av, vertical::observed, vertical_prior(prior)));
  const auto l = judge(matrix(Al, level::observed, level_prior(prior)));
  o.vertical_rank = v.rank;
  o.vertical_condition = v.condition;
  o.level_rank = l.rank;
  o.level_condition = l.condition;
  return o;
}

Observability observability_of(std::span<const Node> nodes, const Channels& channels, std::span<const Tie> ties,
                               std::span<const Fit> fits, const Prior& prior, const Smoothed& smoothed) {
  double moving = 0.0, landmark_sigma = 0.0;
  std::size_t used = 0;
  std::vector<double> distance;  // from the start, at each node
  for (const auto& node : nodes) {
    distance.push_back((distance.empty() ? 0.0 : distance.back()) + std::abs(node.motion.distance));
    if (std::abs(node.speed) > 0.01) moving += node.duration;
  }
  for (std::size_t i = 0; i < ties.size(); ++i) {
    if (!fits[i].used) continue;
    ++used;
    landmark_sigma += std::sqrt(ties[i].covariance.trace() / 3.0);
  }
  if (used == 0 || !(moving > 0.0)) return {};
  landmark_sigma /= static_cast<double>(used);
  const double heading = geodesy::to_euler(nodes.front().q_nv).yaw;
  Observability o =
      observability_at(distance.back() / moving, heading,
                       moving / static_cast<double>(std::max<std::size_t>(used, 2) - 1), prior, landmark_sigma);
  const auto v = judge(stacked<VerticalStep>(channels.vertical, ties, fits, 1, vertical_prior(prior), 2));
  const auto l = judge(stacked<LevelStep>(channels.level, ties, fits, 2, level_prior(prior), 0));
  o.run_vertical_rank = v.rank;
  o.run_vertical_condition = v.condition;
  o.run_level_rank = l.rank;
  o.run_level_condition = l.condition;
  if (o.run_vertical_rank < vertical::size || o.run_level_rank < level::size) {
    o.verdict.push_back(
        fmt::format("{} landmarks determine {} of {} vertical and {} of {} level states by themselves; "
                    "the rest comes from what was given at the start. A third landmark would determine "
                    "the gyro biases too.",
                    used, o.run_vertical_rank, vertical::size, o.run_level_rank, level::size));
  } else {
    o.verdict.push_back(fmt::format("the {} landmarks determine every state by themselves.", used));
  }
  add_states(o, distance, prior, smoothed);
  add_weakest_place(o, distance, ties, fits, smoothed);
  return o;
}

}  // namespace versine::fusion::landmark
