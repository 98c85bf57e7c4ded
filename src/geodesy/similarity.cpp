// SPDX-License-Identifier: Apache-2.0
#include "versine/geodesy/similarity.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "versine/geodesy/attitude.hpp"

namespace versine::geodesy {

Eigen::Vector3d Similarity::apply(const Eigen::Vector3d& source) const {
  Eigen::Vector3d d = rotation * (source - source_centre);
  if (three_dimensional) return target_centre + scale * d;
  d.head<2>() *= scale;  // heights keep their own scale
  return target_centre + d;
}

Eigen::Vector3d Similarity::inverse(const Eigen::Vector3d& target) const {
  Eigen::Vector3d d = target - target_centre;
  if (three_dimensional) return source_centre + rotation.transpose() * d / scale;
  d.head<2>() /= scale;
  return source_centre + rotation.transpose() * d;
}

double Similarity::rotation_z() const {
  return std::atan2(rotation(1, 0), rotation(0, 0));
}

namespace {

/// Quantile of the standard normal, two-sided. Newton on the error function.
double critical(double significance) {
  double z = 3.0;
  for (int i = 0; i < 50; ++i) {
    const double tail = std::erfc(z / std::sqrt(2.0)) - significance;
    const double density = 2.0 * std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::acos(-1.0));
    z = std::max(z + tail / density, 0.1);
  }
  return z;
}

/// Umeyama 1991, eq. 40 to 42, with weights.
void solve(const std::vector<CommonPoint>& points, const std::vector<bool>& used, const SimilarityOptions& o,
           Similarity& s) {
  double weights = 0.0;
  s.source_centre.setZero();
  s.target_centre.setZero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!used[i]) continue;
    const double w = 1.0 / (points[i].sigma * points[i].sigma);
    weights += w;
    s.source_centre += w * points[i].source;
    s.target_centre += w * points[i].target;
  }
  s.source_centre /= weights;
  s.target_centre /= weights;
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  double spread = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!used[i]) continue;
    const double w = 1.0 / (points[i].sigma * points[i].sigma);
    Eigen::Vector3d a = points[i].source - s.source_centre, b = points[i].target - s.target_centre;
    if (!o.three_dimensional) a.z() = b.z() = 0.0;
    correlation += w * b * a.transpose();
    spread += w * a.squaredNorm();
  }
  if (o.three_dimensional) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d d(1.0, 1.0, svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0 ? -1.0 : 1.0);
    s.rotation = svd.matrixU() * d.asDiagonal() * svd.matrixV().transpose();
    s.scale = o.fixed_scale ? 1.0 : svd.singularValues().dot(d) / spread;
  } else {
    const double c = correlation(0, 0) + correlation(1, 1), q = correlation(1, 0) - correlation(0, 1);
    const double angle = std::atan2(q, c);
    s.rotation << std::cos(angle), -std::sin(angle), 0.0, std::sin(angle), std::cos(angle), 0.0, 0.0, 0.0, 1.0;
    s.scale = o.fixed_scale ? 1.0 : std::hypot(c, q) / spread;
  }
}

/// Derivatives of a transformed point by the parameters at the centre.
Eigen::MatrixXd design(const Similarity& s, const Eigen::Vector3d& source, const SimilarityOptions& o) {
  const Eigen::Vector3d d = s.scale * (s.rotation * (source - s.source_centre));
  if (o.three_dimensional) {
    Eigen::MatrixXd a(3, o.fixed_scale ? 6 : 7);
    a.leftCols<3>().setIdentity();
    a.middleCols<3>(3) = -skew(d);
    if (!o.fixed_scale) a.col(6) = d / s.scale;
    return a;
  }
  Eigen::MatrixXd a(2, o.fixed_scale ? 3 : 4);
  a.leftCols<2>().setIdentity();
  a.col(2) << -d.y(), d.x();
  if (!o.fixed_scale) a.col(3) << d.x() / s.scale, d.y() / s.scale;
  return a;
}

/// Residuals, their own sigmas and the parameters' sigmas. Points that are not used are compared with the result.
void judge(const std::vector<CommonPoint>& points, const std::vector<bool>& used, const SimilarityOptions& o,
           Similarity& s) {
  const Eigen::Index dim = o.three_dimensional ? 3 : 2,
                     unknowns = (o.three_dimensional ? 6 : 3) + (o.fixed_scale ? 0 : 1);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  double sum = 0.0, weights = 0.0;
  Eigen::Index count = 0;
  s.residuals.assign(points.size(), {});
  for (std::size_t i = 0; i < points.size(); ++i) {
    SimilarityResidual& r = s.residuals[i];
    r.name = points[i].name;
    r.residual = points[i].target - s.apply(points[i].source);
    r.outlying = !used[i];
    if (!o.three_dimensional) r.residual.z() = 0.0;
    if (!used[i]) continue;
    const Eigen::MatrixXd a = design(s, points[i].source, o);
    const double w = 1.0 / (points[i].sigma * points[i].sigma);
    normal += w * a.transpose() * a;
    sum += w * r.residual.squaredNorm();
    weights += w;
    count += dim;
  }
  const Eigen::VectorXd scale = normal.diagonal().array().rsqrt();
  const Eigen::MatrixXd q = scale.asDiagonal() *
                            Eigen::MatrixXd((scale.asDiagonal() * normal * scale.asDiagonal()))
                                .ldlt()
                                .solve(Eigen::MatrixXd::Identity(unknowns, unknowns)) *
                            scale.asDiagonal();
  s.redundancy = static_cast<int>(count - unknowns);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  s.sigma0 = s.redundancy > 0 ? std::sqrt(sum / s.redundancy) : nan;
  s.parameter_sigma = q.diagonal().array().sqrt();
  if (!o.three_dimensional) {
    s.parameter_sigma.conservativeResize(unknowns + 1);
    s.parameter_sigma[unknowns] = 1.0 / std::sqrt(weights);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    SimilarityResidual& r = s.residuals[i];
    const Eigen::MatrixXd a = design(s, points[i].source, o);
    const double own = points[i].sigma * points[i].sigma;
    const Eigen::VectorXd spread = (a * q * a.transpose()).diagonal();
    r.normalized = s.redundancy > 0 ? 0.0 : nan;
    for (Eigen::Index k = 0; k < dim; ++k) {
      const double variance = own + (used[i] ? -1.0 : 1.0) * spread[k];
      if (variance > 1e-9 * own) r.normalized = std::max(r.normalized, std::abs(r.residual[k]) / std::sqrt(variance));
    }
  }
}

Expected<void> check(const std::vector<CommonPoint>& points, const SimilarityOptions& o) {
  const std::size_t needed = o.three_dimensional ? 3 : 2;
  for (const CommonPoint& p : points) {
    if (p.source.allFinite() && p.target.allFinite() && p.sigma > 0.0) continue;
    return fail({.field = "common point " + p.name,
                 .found = "a coordinate or sigma that is no positive finite number",
                 .expected = "coordinates in metres and a positive sigma"});
  }
  if (points.size() >= needed) return {};
  return fail(
      {.field = "common points",
       .found = fmt::format("{}", points.size()),
       .expected = fmt::format("at least {} {}", needed, o.three_dimensional ? "(7 parameters)" : "(4 parameters)"),
       .advice = "measure or name more points that are known in both systems"});
}

Expected<void> check_spread(const std::vector<CommonPoint>& points, const SimilarityOptions& o) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const CommonPoint& p : points) centre += p.source / static_cast<double>(points.size());
  for (const CommonPoint& p : points) {
    Eigen::Vector3d d = p.source - centre;
    if (!o.three_dimensional) d.z() = 0.0;
    m += d * d.transpose();
  }
  const Eigen::Vector3d size = m.jacobiSvd().singularValues().cwiseSqrt();
  if (size[0] > 1e-3 && (!o.three_dimensional || size[1] > 1e-3 * size[0])) return {};
  return fail({.field = "common points",
               .found = size[0] > 1e-3 ? "points in one line" : "points at one place",
               .expected = o.three_dimensional ? "three points not in a line" : "two points apart",
               .advice = "take points at both ends of the site"});
}

}  // namespace

Expected<Similarity> fit_similarity(const std::vector<CommonPoint>& points, const SimilarityOptions& options) {
  if (auto good = check(points, options); !good) return tl::unexpected(good.error());
  if (auto good = check_spread(points, options); !good) return tl::unexpected(good.error());
  const double limit = critical(options.significance);
  std::vector<bool> used(points.size(), true);
  Similarity s;
  s.three_dimensional = options.three_dimensional;
  for (;;) {
    solve(points, used, options, s);
    judge(points, used, options, s);
    // One point at a time, and only while the rest still control each other.
    const int dim = options.three_dimensional ? 3 : 2;
    if (s.redundancy <= dim) return s;
    std::size_t worst = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (used[i] && (worst == points.size() || s.residuals[i].normalized > s.residuals[worst].normalized)) worst = i;
    }
    if (!(s.residuals[worst].normalized > limit)) return s;
    used[worst] = false;
    std::vector<CommonPoint> rest;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (used[i]) rest.push_back(points[i]);
    }
    if (!check_spread(rest, options)) {
      used[worst] = true;
      solve(points, used, options, s);
      judge(points, used, options, s);
      return s;
    }
  }
}

}  // namespace versine::geodesy
