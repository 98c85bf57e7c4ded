// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/LU>
#include <stdexcept>

#include "fusion/scenario.hpp"

/// What the tests of the aided INS share: a run that must succeed, and its errors against the truth.
namespace versine::test {

inline fusion::AidedInsResult solve(const Simulated& run) {
  SilentProgress progress;
  SilentLog log;
  auto r = fusion::run_aided_ins(run.input, run.options, progress, log);
  if (!r) throw std::runtime_error(r.error().message());
  return *r;
}

inline Errors error_of(const Scenario& s, const Simulated& run, const geodesy::TrajectoryPoint& p) {
  return error_at(p, truth_at(s, run.truth, (p.time - s.motion.epoch).seconds()));
}

/// Normalised squares of the errors of one point: three degrees of freedom each.
struct Nees {
  double position = 0.0, velocity = 0.0, attitude = 0.0;
  Nees& operator+=(const Nees& o) {
    position += o.position, velocity += o.velocity, attitude += o.attitude;
    return *this;
  }
};
inline Nees nees(const Scenario& s, const Simulated& run, const geodesy::TrajectoryPoint& p) {
  const Errors e = error_of(s, run, p);
  const auto normalised = [](const Eigen::Vector3d& x, const Eigen::Matrix3d& P) { return x.dot(P.inverse() * x); };
  return {normalised(e.position, p.position_covariance.matrix()),
          normalised(e.velocity, p.velocity_covariance.matrix()),
          normalised(e.attitude, p.attitude_covariance.matrix())};
}

/// Largest position error and how many sigmas it is at its worst (each axis by itself), between two times.
struct Worst {
  double position = 0.0, sigmas = 0.0;
};
inline Worst worst_between(const Scenario& s, const Simulated& run, const fusion::AidedInsResult& r, double from,
                           double to) {
  Worst worst;
  for (const auto& p : r.solution.smoothed) {
    const double t = (p.time - s.motion.epoch).seconds();
    if (t < from || t > to) continue;
    const Eigen::Vector3d e = error_of(s, run, p).position;
    const Eigen::Vector3d sigma = p.position_covariance.matrix().diagonal().cwiseSqrt();
    const double sigmas = e.cwiseAbs().cwiseQuotient(sigma).maxCoeff();
    if (!(sigmas <= worst.sigmas)) worst.sigmas = sigmas;  // a NaN stays
    if (!(e.norm() <= worst.position)) worst.position = e.norm();
  }
  return worst;
}

}  // namespace versine::test
