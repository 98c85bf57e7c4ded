// SPDX-License-Identifier: Apache-2.0
#include "profile_fit.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "axis_covariance.hpp"
#include "versine/design/segmentation.hpp"

namespace versine::design {

namespace {

double robust_sigma(const Eigen::VectorXd& v) {
  std::vector<double> size(v.data(), v.data() + v.size());
  for (double& x : size) x = std::abs(x);
  const auto middle = size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2);
  std::nth_element(size.begin(), middle, size.end());
  return std::max(1.4826 * *middle, 1e-6);
}

struct Observation {
  double distance, value;
};

template <class Value>
std::vector<Observation> observed(std::span<const TrackSample> samples, const std::vector<double>& distance,
                                  const Value& value) {
  std::vector<Observation> out;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (std::isfinite(value(samples[i]))) out.push_back({distance[i], value(samples[i])});
  }
  return out;
}

double spacing_of(const std::vector<Observation>& seen) {
  return (seen.back().distance - seen.front().distance) / static_cast<double>(seen.size() - 1);
}

}  // namespace

void fit_cant(std::span<const TrackSample> samples, const std::vector<double>& distance, double huber,
              OptimalAxis& out) {
  const auto seen = observed(samples, distance, [](const TrackSample& s) { return s.cant; });
  const auto& elements = out.alignment.horizontal.elements();
  const auto unknowns = static_cast<Eigen::Index>((elements.size() + 1) / 2);
  if (static_cast<Eigen::Index>(seen.size()) < 2 * unknowns) return;
  const auto n = static_cast<Eigen::Index>(seen.size());
  Eigen::VectorXd y(n), weight = Eigen::VectorXd::Ones(n), x, residual;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, unknowns), inverse;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Observation& o = seen[static_cast<std::size_t>(i)];
    const std::size_t e = out.alignment.horizontal.element_at(o.distance);
    const auto k = static_cast<Eigen::Index>(e / 2);
    y[i] = o.value;
    if (e % 2 == 0) {
      a(i, k) = 1.0;
    } else {
      const double xi = std::clamp((o.distance - elements[e].distance) / elements[e].element.length, 0.0, 1.0);
      const double f = ramp(elements[e].element.shape, xi);
      a(i, k) = 1.0 - f;
      a(i, k + 1) = f;
    }
  }
  double sigma = 1.0;
  for (int round = 0; round < 4; ++round) {
    Eigen::MatrixXd normal = a.transpose() * weight.asDiagonal() * a;
    normal.diagonal().array() += 1e-9;  // an element without a sample keeps zero
    inverse = normal.ldlt().solve(Eigen::MatrixXd::Identity(unknowns, unknowns));
    x = inverse * (a.transpose() * (weight.asDiagonal() * y));
    residual = y - a * x;
    sigma = robust_sigma(residual);
    for (Eigen::Index i = 0; i < n; ++i) weight[i] = std::min(1.0, huber * sigma / (std::abs(residual[i]) + 1e-300));
  }
  const Eigen::VectorXd root = weight.cwiseSqrt();
  const Eigen::MatrixXd covariance =
      covariance_of_fit(root.asDiagonal() * a, root.cwiseProduct(residual), 1, spacing_of(seen));
  std::vector<CantPoint> points;
  for (std::size_t e = 0; e < elements.size(); e += 2) {
    const double value = x[static_cast<Eigen::Index>(e / 2)];
    const Shape next = e + 1 < elements.size() ? elements[e + 1].element.shape : Shape::clothoid;
    points.push_back({elements[e].distance, value, Shape::clothoid});
    points.push_back({elements[e].distance + elements[e].element.length, value, next});
    const auto k = static_cast<Eigen::Index>(e / 2);
    out.sigma[e].cant = std::sqrt(std::max(covariance(k, k), 0.0));
  }
  out.alignment.cant = *CantProfile::from_points(std::move(points));
  out.cant_rms = std::sqrt(residual.squaredNorm() / static_cast<double>(n));
}

namespace {

/// Gradients and parabolas as a chain: height at the start, gradients, and the places of the intersections with the
/// lengths of their parabolas.
struct ProfileChain {
  double start = 0.0, height = 0.0;
  std::vector<double> gradient;        // n
  std::vector<double> place, rounded;  // n - 1: intersection, length of the parabola

  /// Sum over gradients of smooth bends: each parabola bends by its change of gradient.
  [[nodiscard]] double at(double s) const {
    double h = height + gradient[0] * (s - start);
    for (std::size_t k = 0; k < place.size(); ++k) {
      const double turn = gradient[k + 1] - gradient[k], half = 0.5 * rounded[k];
      const double v = s - (place[k] - half);
      if (v <= 0.0) break;
      h += v >= rounded[k] ? turn * (s - place[k]) : turn * v * v / (2.0 * rounded[k]);
    }
    return h;
  }
};

struct ProfileCost {
  const ProfileChain& base;
  const std::vector<Observation>& seen;
  const Eigen::VectorXd& weight;
  static ProfileChain chain(const ProfileChain& base, const double* x) {
    ProfileChain c = base;
    const std::size_t n = base.gradient.size();
    c.height = x[0];
    for (std::size_t k = 0; k < n; ++k) c.gradient[k] = x[1 + k];
    for (std::size_t k = 0; k + 1 < n; ++k) {
      c.place[k] = x[1 + n + 2 * k];
      c.rounded[k] = std::max(x[2 + n + 2 * k], 1.0);
    }
    return c;
  }
  static std::vector<double> values(const ProfileChain& c) {
    std::vector<double> x = {c.height};
    x.insert(x.end(), c.gradient.begin(), c.gradient.end());
    for (std::size_t k = 0; k < c.place.size(); ++k) x.insert(x.end(), {c.place[k], c.rounded[k]});
    return x;
  }
  bool operator()(double const* const* x, double* residual) const {
    const ProfileChain c = chain(base, x[0]);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      residual[i] = weight[static_cast<Eigen::Index>(i)] * 1e3 * (c.at(seen[i].distance) - seen[i].value);
    }
    return true;
  }
};

ProfileChain seed_profile(const std::vector<Observation>& seen, const OptimalAxisOptions& o) {
  // Heights at equal cells, segmented into straight and curved pieces.
  const double start = seen.front().distance, cell = o.cell;
  const auto n = std::max<std::size_t>(static_cast<std::size_t>((seen.back().distance - start) / cell), 1);
  std::vector<double> sum(n, 0.0), value(n, 0.0);
  std::vector<int> count(n, 0);
  for (const Observation& s : seen) {
    const auto i = static_cast<std::size_t>(std::max(s.distance - start, 0.0) / cell);
    if (i >= n) continue;
    sum[i] += s.value;
    ++count[i];
  }
  for (std::size_t i = 0; i < n; ++i)
    value[i] = count[i] > 0 ? sum[i] / count[i] : i > 0 ? value[i - 1] : seen[0].value;
  ProfileChain c;
  c.start = start;
  c.height = seen.front().value;
  double last_end = start;
  for (const Segment& s : segment(value, 1, 6.0, 4)) {
    if (s.ramp) continue;
    const double from = start + static_cast<double>(s.from) * cell, gradient = s.level / cell;
    if (!c.gradient.empty()) {
      c.place.push_back(0.5 * (last_end + from));
      c.rounded.push_back(std::max(from - last_end, 2.0 * cell));
    }
    c.gradient.push_back(gradient);
    last_end = start + static_cast<double>(s.to) * cell;
  }
  if (c.gradient.empty()) c.gradient = {(seen.back().value - seen.front().value) / (seen.back().distance - start)};
  return c;
}

ProfileChain solve_profile(ProfileChain c, const std::vector<Observation>& seen, double huber,
                           Eigen::VectorXd& residual) {
  const auto n = static_cast<Eigen::Index>(seen.size());
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(n);
  residual.resize(n);
  std::vector<double> x = ProfileCost::values(c);
  for (int round = 0; round < 3; ++round) {
    auto* cost =
        new ceres::DynamicNumericDiffCostFunction<ProfileCost, ceres::CENTRAL>(new ProfileCost{c, seen, weight});
    cost->AddParameterBlock(static_cast<int>(x.size()));
    cost->SetNumResiduals(static_cast<int>(n));
    ceres::Problem problem;
    problem.AddResidualBlock(cost, nullptr, x.data());
    const std::size_t g = c.gradient.size();
    // Intersections keep their order: each stays between the middles towards its neighbours.
    for (std::size_t k = 0; k + 1 < g; ++k) {
      const auto at = static_cast<int>(1 + g + 2 * k);
      const double low = k > 0 ? 0.5 * (c.place[k - 1] + c.place[k]) : c.start;
      const double high = k + 2 < g ? 0.5 * (c.place[k] + c.place[k + 1]) : seen.back().distance;
      problem.SetParameterLowerBound(x.data(), at, std::min(low, c.place[k]));
      problem.SetParameterUpperBound(x.data(), at, std::max(high, c.place[k]));
      problem.SetParameterLowerBound(x.data(), at + 1, 1.0);
      problem.SetParameterUpperBound(x.data(), at + 1, std::max(high - low, 2.0));
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 30;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    const ProfileChain now = ProfileCost::chain(c, x.data());
    for (Eigen::Index i = 0; i < n; ++i) {
      const Observation& o = seen[static_cast<std::size_t>(i)];
      residual[i] = o.value - now.at(o.distance);
    }
    const double sigma = robust_sigma(residual);
    for (Eigen::Index i = 0; i < n; ++i) {
      weight[i] = std::sqrt(std::min(1.0, huber * sigma / (std::abs(residual[i]) + 1e-300)));
    }
  }
  return ProfileCost::chain(c, x.data());
}

/// Gradients that differ by less than the noise shows become one; parabolas may not overlap.
bool prune_profile(ProfileChain& c, double noise, double end) {
  for (std::size_t k = 0; k < c.place.size(); ++k) {
    const double before = c.place[k] - (k > 0 ? c.place[k - 1] : c.start);
    const double after = (k + 1 < c.place.size() ? c.place[k + 1] : end) - c.place[k];
    const double reach = std::min(before, after);
    const bool faint = std::abs(c.gradient[k + 1] - c.gradient[k]) * reach / 4.0 < 2.0 * noise;
    const bool disorder = !(before > 1.0) || !(after > 1.0);
    if (!faint && !disorder) continue;
    const auto at = static_cast<std::ptrdiff_t>(k);
    const double share = std::clamp(before / (before + after), 0.0, 1.0);
    c.gradient[k] = share * c.gradient[k] + (1.0 - share) * c.gradient[k + 1];
    c.gradient.erase(c.gradient.begin() + at + 1);
    c.place.erase(c.place.begin() + at);
    c.rounded.erase(c.rounded.begin() + at);
    return true;
  }
  return false;
}

/// Whatever happens above: intersections in order, a metre apart at least.
void order(ProfileChain& c, double end) {
  for (std::size_t k = 0; k < c.place.size();) {
    const double before = k > 0 ? c.place[k - 1] : c.start;
    if (c.place[k] > before + 1.0 && c.place[k] < end - 1.0) {
      ++k;
      continue;
    }
    const auto at = static_cast<std::ptrdiff_t>(k);
    c.gradient.erase(c.gradient.begin() + at);
    c.place.erase(c.place.begin() + at);
    c.rounded.erase(c.rounded.begin() + at);
  }
}

/// Derivatives by differences, then as for the axis.
std::vector<GradientSigma> gradient_sigmas(const ProfileChain& c, const std::vector<Observation>& seen,
                                           const Eigen::VectorXd& residual, double huber) {
  const std::vector<double> x = ProfileCost::values(c);
  const auto n = static_cast<Eigen::Index>(seen.size());
  const std::size_t g = c.gradient.size();
  const double sigma = robust_sigma(residual);
  const Eigen::VectorXd root = (huber * sigma / (residual.array().abs() + 1e-300)).min(1.0).sqrt();
  Eigen::MatrixXd j(n, static_cast<Eigen::Index>(x.size()));
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double h = k == 0 ? 1e-3 : k <= g ? 1e-6 : 0.05;
    std::vector<double> plus = x, minus = x;
    plus[k] += h;
    minus[k] -= h;
    const ProfileChain a = ProfileCost::chain(c, plus.data()), b = ProfileCost::chain(c, minus.data());
    for (Eigen::Index i = 0; i < n; ++i) {
      const double s = seen[static_cast<std::size_t>(i)].distance;
      j(i, static_cast<Eigen::Index>(k)) = root[i] * (a.at(s) - b.at(s)) / (2.0 * h);
    }
  }
  const Eigen::MatrixXd covariance = covariance_of_fit(j, root.cwiseProduct(residual), 1, spacing_of(seen));
  const auto of = [&](std::size_t k) {
    const auto i = static_cast<Eigen::Index>(k);
    return std::sqrt(std::max(covariance(i, i), 0.0));
  };
  std::vector<GradientSigma> out(g);
  for (std::size_t k = 0; k < g; ++k) {
    out[k].gradient = of(1 + k);
    if (k > 0) out[k].place = of(1 + g + 2 * (k - 1));
    if (k > 0) out[k].curve = of(2 + g + 2 * (k - 1));
  }
  return out;
}

}  // namespace

Expected<void> fit_profile(std::span<const TrackSample> samples, const std::vector<double>& distance,
                           const OptimalAxisOptions& options, OptimalAxis& out) {
  const auto seen = observed(samples, distance, [](const TrackSample& s) { return s.height; });
  if (seen.size() < 20) return {};
  Eigen::VectorXd residual;
  ProfileChain c = solve_profile(seed_profile(seen, options), seen, options.huber, residual);
  const double end = seen.back().distance;
  // A step less may cost a little; when it costs more, the profile before it stays.
  double noise = robust_sigma(residual);
  for (int round = 0; round < 50; ++round) {
    ProfileChain fewer = c;
    if (!prune_profile(fewer, noise, end)) break;
    Eigen::VectorXd next;
    fewer = solve_profile(fewer, seen, options.huber, next);
    if (robust_sigma(next) > 1.2 * noise) break;
    c = std::move(fewer);
    residual = std::move(next);
    noise = std::min(noise, robust_sigma(residual));
  }
  order(c, end);
  out.gradient_sigma = gradient_sigmas(c, seen, residual, options.huber);
  std::vector<VerticalPoint> points = {{.distance = c.start, .height = c.height}};
  for (std::size_t k = 0; k < c.place.size(); ++k) {
    const double height = points.back().height + c.gradient[k] * (c.place[k] - points.back().distance);
    // A parabola may reach to its neighbours' middle at most.
    const double room = std::min(c.place[k] - (k > 0 ? 0.5 * (c.place[k] + c.place[k - 1]) : c.start),
                                 (k + 1 < c.place.size() ? 0.5 * (c.place[k] + c.place[k + 1]) : end) - c.place[k]);
    points.push_back({c.place[k], height, VerticalPoint::Curve::parabola, std::min(c.rounded[k], 2.0 * room)});
  }
  points.push_back({end, points.back().height + c.gradient.back() * (end - points.back().distance)});
  auto profile = Profile::from_points(std::move(points));
  if (!profile) return tl::unexpected(profile.error());
  out.alignment.profile = *std::move(profile);
  out.height_rms = std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()));
  return {};
}

}  // namespace versine::design
