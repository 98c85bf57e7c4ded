// SPDX-License-Identifier: Apache-2.0
#include "axis_fit.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "axis_covariance.hpp"

namespace versine::design {

void connect(Chain& chain) {
  for (std::size_t i = 0; i < chain.elements.size(); i += 2) {
    HorizontalElement& e = chain.elements[i];
    e.shape = e.curvature_start == 0.0 ? Shape::line : Shape::arc;
    e.curvature_end = e.curvature_start;
    if (i > 0) chain.elements[i - 1].curvature_end = e.curvature_start;
    if (i + 1 < chain.elements.size()) chain.elements[i + 1].curvature_start = e.curvature_start;
  }
}

namespace {

constexpr double shortest_length = 0.05;  // m; the solver keeps lengths above this

/// What the unknowns are, and a chain made from their values.
struct Unknowns {
  Chain base;
  std::vector<int> length, curvature;  // index of the unknown, -1: fixed
  int count = 2;                       // offset across the start's heading, and the heading

  explicit Unknowns(const Chain& chain) : base(chain) {
    const std::size_t n = chain.elements.size();
    length.assign(n, -1);
    curvature.assign(n, -1);
    for (std::size_t i = 0; i < n; ++i) {
      // The last element ends with the track: its length is no unknown.
      if (!chain.fixed_length[i] && i + 1 < n) length[i] = count++;
      if (i % 2 == 0 && !chain.fixed_curvature[i]) curvature[i] = count++;
    }
  }
  [[nodiscard]] std::vector<double> values() const {
    std::vector<double> x(static_cast<std::size_t>(count), 0.0);
    for (std::size_t i = 0; i < length.size(); ++i) {
      if (length[i] >= 0) x[static_cast<std::size_t>(length[i])] = base.elements[i].length;
      if (curvature[i] >= 0) x[static_cast<std::size_t>(curvature[i])] = base.elements[i].curvature_start;
    }
    return x;
  }
  [[nodiscard]] Chain chain(const double* x) const {
    Chain c = base;
    c.start.easting += x[0] * std::cos(base.start.heading);
    c.start.northing -= x[0] * std::sin(base.start.heading);
    c.start.heading += x[1];
    for (std::size_t i = 0; i < length.size(); ++i) {
      if (length[i] >= 0) c.elements[i].length = std::max(x[length[i]], shortest_length);
      if (curvature[i] >= 0) c.elements[i].curvature_start = x[curvature[i]];
    }
    connect(c);
    return c;
  }
};

/// How a place moves with one unknown: by (easting, northing) and a turn about a pivot.
struct Motion {
  double easting = 0.0, northing = 0.0, turn = 0.0;
  MapPosition pivot;
};

/// Derivative of an element's pose at u by one of its own numbers; central differences of the exact evaluator.
template <class Change>
Motion local_motion(const HorizontalElement& e, const MapPose& start, double u, double h, const Change& change) {
  HorizontalElement plus = e, minus = e;
  double u_plus = u, u_minus = u;
  change(plus, u_plus, h);
  change(minus, u_minus, -h);
  const AxisPose a = pose_on(plus, start, u_plus), b = pose_on(minus, start, u_minus);
  const double f = 0.5 / h;
  return {(a.easting - b.easting) * f, (a.northing - b.northing) * f, (a.heading - b.heading) * f, {}};
}

const auto change_start = [](HorizontalElement& e, double&, double h) {
  e.curvature_start += h;
  if (!is_transition(e.shape)) e.curvature_end += h;
  if (e.shape == Shape::line) e.shape = Shape::arc;
};
const auto change_end = [](HorizontalElement& e, double&, double h) { e.curvature_end += h; };
const auto change_length = [](HorizontalElement& e, double&, double h) { e.length += h; };
const auto change_whole = [](HorizontalElement& e, double& u, double h) {
  e.length += h;
  u += h;
};
constexpr double dk = 1e-7, dl = 1e-3;

/// Offsets and headings of all samples against the chain, and their derivatives.
class Problem {
 public:
  Problem(const Unknowns& unknowns, std::span<const TrackSample> samples)
      : unknowns_(unknowns), samples_(samples), distance_(samples.size()) {
    for (std::size_t i = 0; i < samples.size(); ++i) distance_[i] = samples[i].distance - samples[0].distance;
  }

  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  [[nodiscard]] const std::vector<double>& distance() const { return distance_; }
  [[nodiscard]] const Unknowns& unknowns() const { return unknowns_; }

  /// Residuals (offset, heading) interleaved; jacobian rows likewise when wanted.
  bool evaluate(const double* x, Eigen::VectorXd& residual,
                Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>* jacobian) {
    const Chain chain = unknowns_.chain(x);
    const auto axis = HorizontalAxis::chain(chain.start, chain.elements);
    if (!axis) return false;
    if (jacobian != nullptr) prepare(*axis);
    residual.resize(2 * static_cast<Eigen::Index>(size()));
    if (jacobian != nullptr) jacobian->setZero(residual.size(), unknowns_.count);
    for (std::size_t i = 0; i < size(); ++i) {
      const TrackSample& p = samples_[i];
      AxisPose pose;
      double along = 0.0, across = 0.0;
      // A few Newton steps from where the foot was last time.
      for (int k = 0; k < 4; ++k) {
        pose = axis->at(distance_[i]);
        const double c = std::cos(pose.heading), s = std::sin(pose.heading);
        const double e = p.easting - pose.easting, n = p.northing - pose.northing;
        along = s * e + c * n;
        across = c * e - s * n;
        if (std::abs(along) < 1e-7 || k == 3) break;
        distance_[i] += along / std::max(1.0 - pose.curvature * across, 0.2);
      }
      const auto row = 2 * static_cast<Eigen::Index>(i);
      residual[row] = across;
      residual[row + 1] = std::remainder(p.heading - pose.heading, 2.0 * std::numbers::pi);
      if (jacobian != nullptr) differentiate(*axis, i, pose, across, jacobian->row(row), jacobian->row(row + 1));
    }
    return true;
  }

 private:
  /// Motion of everything behind each element with its own three numbers.
  struct Ends {
    Motion start, end, length;
  };
  void prepare(const HorizontalAxis& axis) {
    ends_.clear();
    for (const auto& placed : axis.elements()) {
      const HorizontalElement& e = placed.element;
      const AxisPose end = pose_on(e, placed.start, e.length);
      Ends m;
      m.start = local_motion(e, placed.start, e.length, dk, change_start);
      if (is_transition(e.shape)) m.end = local_motion(e, placed.start, e.length, dk, change_end);
      m.length = local_motion(e, placed.start, e.length, dl, change_whole);
      m.start.pivot = m.end.pivot = m.length.pivot = {end.easting, end.northing};
      ends_.push_back(m);
    }
  }

  template <class RowRef>
  void differentiate(const HorizontalAxis& axis, std::size_t i, const AxisPose& pose, double across, RowRef&& offset,
                     RowRef&& heading) const {
    const double c = std::cos(pose.heading), s = std::sin(pose.heading);
    const double lever = pose.curvature / std::max(1.0 - pose.curvature * across, 0.2);
    const auto apply = [&](int unknown, const Motion& m, bool about_pivot) {
      if (unknown < 0) return;
      double e = m.easting, n = m.northing;
      if (about_pivot) {  // a clockwise turn moves (e, n) by (n, -e)
        e += m.turn * (pose.northing - m.pivot.northing);
        n -= m.turn * (pose.easting - m.pivot.easting);
      }
      offset[unknown] -= c * e - s * n;
      // The foot moves along the axis too, and the heading with it.
      heading[unknown] -= m.turn - lever * (s * e + c * n);
    };
    const MapPose& start = axis.elements().front().start;
    const double base = unknowns_.base.start.heading;
    apply(0, {std::cos(base), -std::sin(base), 0.0, {}}, false);
    apply(1, {0.0, 0.0, 1.0, {start.easting, start.northing}}, true);
    const std::size_t own = axis.element_at(distance_[i]);
    for (std::size_t j = 0; j < own; ++j) {
      apply(unknowns_.length[j], ends_[j].length, true);
      if (j % 2 == 0) {
        apply(unknowns_.curvature[j], ends_[j].start, true);
      } else {
        apply(unknowns_.curvature[j - 1], ends_[j].start, true);
        apply(unknowns_.curvature[j + 1], ends_[j].end, true);
      }
    }
    const auto& placed = axis.elements()[own];
    const double u = std::clamp(distance_[i] - placed.distance, 0.0, placed.element.length);
    const HorizontalElement& e = placed.element;
    if (own % 2 == 0) {
      apply(unknowns_.curvature[own], local_motion(e, placed.start, u, dk, change_start), false);
    } else {
      apply(unknowns_.length[own], local_motion(e, placed.start, u, dl, change_length), false);
      apply(unknowns_.curvature[own - 1], local_motion(e, placed.start, u, dk, change_start), false);
      apply(unknowns_.curvature[own + 1], local_motion(e, placed.start, u, dk, change_end), false);
    }
  }

  Unknowns unknowns_;
  std::span<const TrackSample> samples_;
  std::vector<double> distance_;
  std::vector<Ends> ends_;
};

/// Standard deviations of offsets and headings, and each sample's weight (Huber).
struct Weights {
  double offset = 1.0, heading = 1.0;
  Eigen::VectorXd sample;
};

double robust_sigma(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return 1.4826 * *middle;
}

Weights weigh(const Eigen::VectorXd& residual, double huber, std::size_t& outliers) {
  const Eigen::Index n = residual.size() / 2;
  std::vector<double> offset, heading;
  for (Eigen::Index i = 0; i < n; ++i) {
    offset.push_back(residual[2 * i]);
    heading.push_back(residual[2 * i + 1]);
  }
  Weights w{std::max(robust_sigma(offset), 1e-5), std::max(robust_sigma(heading), 1e-6), Eigen::VectorXd::Ones(n)};
  outliers = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double size = std::max(std::abs(residual[2 * i]) / w.offset, std::abs(residual[2 * i + 1]) / w.heading);
    if (size <= huber) continue;
    w.sample[i] = huber / size;
    ++outliers;
  }
  return w;
}

/// All residuals as one function of all unknowns: each depends on everything before it, so the Jacobian is dense.
class Cost : public ceres::CostFunction {
 public:
  Cost(Problem& problem, const Weights& weights) : problem_(problem), weights_(weights) {
    set_num_residuals(static_cast<int>(2 * problem.size()));
    mutable_parameter_block_sizes()->push_back(problem.unknowns().count);
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    Eigen::VectorXd r;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> j;
    const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
    if (!problem_.evaluate(x[0], r, wanted ? &j : nullptr)) return false;
    for (Eigen::Index i = 0; i < r.size() / 2; ++i) {
      const double w = std::sqrt(weights_.sample[i]);
      const double a = w / weights_.offset, b = w / weights_.heading;
      residuals[2 * i] = a * r[2 * i];
      residuals[2 * i + 1] = b * r[2 * i + 1];
      if (!wanted) continue;
      j.row(2 * i) *= a;
      j.row(2 * i + 1) *= b;
    }
    if (wanted) std::copy(j.data(), j.data() + j.size(), jacobians[0]);
    return true;
  }

 private:
  Problem& problem_;
  const Weights& weights_;
};

}  // namespace

ChainFit fit_chain(const Chain& start, std::span<const TrackSample> samples, double huber, bool with_covariance) {
  const Unknowns unknowns(start);
  Problem problem(unknowns, samples);
  std::vector<double> x = unknowns.values();
  ChainFit fit;
  const auto n = static_cast<Eigen::Index>(samples.size());
  Weights weights{1.0, 0.02, Eigen::VectorXd::Ones(n)};  // at first the headings lead: the far end may be metres off
  Eigen::VectorXd residual;
  for (int round = 0; round < 4; ++round) {
    ceres::Problem solver;
    solver.AddResidualBlock(new Cost(problem, weights), nullptr, x.data());
    for (const int i : unknowns.length) {
      if (i >= 0) solver.SetParameterLowerBound(x.data(), i, shortest_length);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = round == 0 ? 60 : 25;
    options.function_tolerance = 1e-9;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &solver, &summary);
    if (!problem.evaluate(x.data(), residual, nullptr)) break;
    weights = weigh(residual, huber, fit.outliers);
  }
  fit.chain = unknowns.chain(x.data());
  fit.length_index = unknowns.length;
  fit.curvature_index = unknowns.curvature;
  fit.distance = problem.distance();
  fit.offset = Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<2>>(residual.data(), n);
  fit.heading = Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<2>>(residual.data() + 1, n);
  fit.unknowns = {"start offset", "start heading"};
  fit.unknowns.resize(static_cast<std::size_t>(unknowns.count));
  for (std::size_t i = 0; i < unknowns.length.size(); ++i) {
    const auto name = [&](int index, const char* what) {
      if (index >= 0) fit.unknowns[static_cast<std::size_t>(index)] = fmt::format("{} of element {}", what, i + 1);
    };
    name(unknowns.length[i], "length");
    name(unknowns.curvature[i], "curvature");
  }
  if (with_covariance) {
    Cost cost(problem, weights);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> j(2 * n, unknowns.count);
    Eigen::VectorXd r(2 * n);
    const double* parameter = x.data();
    double* jacobian = j.data();
    cost.Evaluate(&parameter, r.data(), &jacobian);
    const double step = (samples.back().distance - samples.front().distance) / static_cast<double>(n - 1);
    fit.covariance = covariance_of_fit(j, r, 2, step);
  }
  return fit;
}

}  // namespace versine::design
