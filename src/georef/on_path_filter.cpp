// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "motion.hpp"
#include "versine/georef/on_path.hpp"

namespace versine::georef {

namespace {

/// The path seen from a predicted distance: the point, its derivative, and the directions along and across.
struct View {
  Eigen::Vector2d point, along, across;
  double slope = 1.0;  // map metres per metre of d
};

View view(const network::PathCoordinates& path, double d, double sigma_d, const Options& options) {
  View v;
  Eigen::Vector2d derivative;
  if (options.linearisation == Linearisation::unscented) {
    // Three sigma points in d, the only state that enters phi non-linearly.
    const double h = std::sqrt(3.0) * std::max(sigma_d, 1e-3);
    const Eigen::Vector2d low = path.position(d - h), mid = path.position(d), high = path.position(d + h);
    v.point = (low + 4.0 * mid + high) / 6.0;
    derivative = (high - low) / (2.0 * h);
  } else {
    v.point = path.position(d);
    derivative = path.derivative(d, options.jacobian_step);
  }
  v.slope = std::max(derivative.norm(), 1e-6);
  v.along = derivative / v.slope;
  v.across = {v.along.y(), -v.along.x()};
  return v;
}

double log_gauss(double r, double variance) {
  return -0.5 * (r * r / variance + std::log(2.0 * std::numbers::pi * variance));
}

/// Logarithm of Student's t density; what depends on its degrees of freedom only is worked out once.
class LogStudent {
 public:
  explicit LogStudent(double nu)
      : nu_(nu),
        one_(std::lgamma(0.5 * (nu + 1.0)) - std::lgamma(0.5 * nu) - 0.5 * std::log(nu * std::numbers::pi)),
        two_(std::lgamma(0.5 * (nu + 2.0)) - std::lgamma(0.5 * nu) - std::log(nu * std::numbers::pi)) {}
  /// In one dimension.
  [[nodiscard]] double one(double nis, double variance) const {
    return one_ - 0.5 * std::log(variance) - 0.5 * (nu_ + 1.0) * std::log1p(nis / nu_);
  }
  /// In two; `determinant` of the covariance.
  [[nodiscard]] double two(double nis, double determinant) const {
    return two_ - 0.5 * std::log(determinant) - 0.5 * (nu_ + 2.0) * std::log1p(nis / nu_);
  }

 private:
  double nu_, one_, two_;
};

class PathFilter {
 public:
  PathFilter(const network::PathCoordinates& path, const Epochs& epochs, const Options& options,
             std::span<const double> weights)
      : path_(path),
        epochs_(epochs),
        options_(options),
        weights_(weights),
        student_(options.gnss.nu),
        table_(epochs.motion, epochs.grid, epochs.correlation_time) {}

  Filtered run() {
    initialise();
    const std::size_t n = epochs_.epochs.size();
    out_.predicted.reserve(n), out_.updated.reserve(n);
    out_.predicted_covariance.reserve(n), out_.updated_covariance.reserve(n);
    out_.colour_kept.reserve(n), out_.residuals.reserve(n);
    for (std::size_t k = 0; k < n; ++k) {
      const Epoch& e = epochs_.epochs[k];
      if (k > 0) predict(e, e.step - epochs_.epochs[k - 1].step);
      if (e.position) renew_colour(e);
      out_.colour_kept.push_back(kept_);
      out_.predicted.push_back(x_);
      out_.predicted_covariance.push_back(P_);
      measure(e, k);
      out_.updated.push_back(x_);
      out_.updated_covariance.push_back(P_);
    }
    return std::move(out_);
  }

  /// One epoch, for a caller that keeps the state.
  void advance(const Epoch& e, std::int64_t steps, TrackerState& s) {
    x_ = s.x, P_ = s.P, across_ = s.across, across_variance_ = s.across_variance;
    last_sigma_ = s.last_sigma, astray_ = s.astray;
    if (steps > 0) predict(e, steps);
    if (e.position) renew_colour(e);
    measure(e, 0);
    s.log_likelihood += out_.evidence.likelihood();
    s.x = x_, s.P = P_, s.across = across_, s.across_variance = across_variance_;
    s.last_sigma = last_sigma_, s.astray = astray_;
    if (!out_.residuals.empty()) s.nis = out_.residuals.back().nis, s.weight = out_.residuals.back().weight;
    out_.evidence = {};
    out_.residuals.clear();
  }

 private:
  void measure(const Epoch& e, std::size_t k) {
    if (e.standing) speed(0.0, 1e-4, true);
    if (e.speed) speed(*e.speed, e.sigma_speed * e.sigma_speed, false);
    if (e.position) position(e, k);
    if (e.turn) turn(e);
  }

  void initialise() {
    const auto& es = epochs_.epochs;
    std::size_t first = 0;
    while (first < es.size() && !es[first].position) ++first;
    if (first == es.size()) return;
    // The first fix belongs to the path's first track, or the coarse search would have begun elsewhere.
    const double dt = epochs_.grid * static_cast<double>(es[first].step);
    const bool late = dt > 5.0;
    const double reach = path_.starts()[1] + (path_.starts().size() > 2 ? 300.0 : 0.0);
    const auto at =
        path_.project(late ? epochs_.start_point : *es[first].position, 0.0, std::min(reach, path_.length()));
    x_ << at.distance, 0, 0, 0;
    const double s = es[first].sigma, v = es.front().standing ? 0.3 : 30.0;
    if (!es.front().standing && !late) {  // speed from the next fixes
      for (std::size_t k = first + 1; k < es.size(); ++k) {
        const double lag = epochs_.grid * static_cast<double>(es[k].step - es[first].step);
        if (!es[k].position || lag < 2.0) continue;
        x_[1] = (*es[k].position - *es[first].position).norm() / lag;
        x_[0] -= x_[1] * dt;
        break;
      }
    }
    const double a = epochs_.motion.sigma;
    const double unknown = late ? 2.0 * epochs_.start_sigma : 5.0 * s + 5.0;
    P_ = Eigen::Vector4d(unknown * unknown + v * dt * v * dt, v * v, a * a, 1.0).asDiagonal();
    across_ = 0.0;
    across_variance_ = 1.0;
  }

  void predict(const Epoch& e, std::int64_t steps) {
    const Motion& m = table_.steps(steps);
    kept_ = m.decay;
    const Eigen::Vector3d x = m.F * x_.head<3>();
    x_.head<3>() = x;
    x_.head<2>() += e.input;
    x_[3] *= m.decay;
    const Eigen::Matrix3d K = m.F * P_.topLeftCorner<3, 3>() * m.F.transpose() + m.Q;
    const Eigen::Vector3d c = m.decay * (m.F * P_.topRightCorner<3, 1>());
    P_.topLeftCorner<3, 3>() = K;
    P_.topRightCorner<3, 1>() = c;
    P_.bottomLeftCorner<1, 3>() = c.transpose();
    P_(3, 3) = m.decay * m.decay * P_(3, 3) + 1.0 - m.decay * m.decay;
    across_ *= m.decay;
    across_variance_ = m.decay * m.decay * across_variance_ + 1.0 - m.decay * m.decay;
  }

  /// The correlated error goes on only as far as the receiver's own sigma does, and not where the fix jumps away from
  /// the prediction: under a bridge another error begins. Both errors then start afresh, as large as the jump.
  void renew_colour(const Epoch& e) {
    if (last_sigma_ > 0.0 && e.sigma != last_sigma_) {
      const double kept = std::min(e.sigma, last_sigma_) / std::max(e.sigma, last_sigma_);
      keep_colour(kept, 1.0 - kept * kept);
      across_ *= kept;
      across_variance_ = kept * kept * across_variance_ + 1.0 - kept * kept;
    }
    last_sigma_ = e.sigma;
    const Innovation i = innovation(e);
    if (!(i.ra * i.ra / i.Sa + i.rc * i.rc / i.Sc > options_.gnss.jump) || gross(i, e)) return;
    out_.evidence.position -= 4.6;  // one fix in a hundred
    keep_colour(0.0, std::max(1.0, i.along * i.along / (i.coloured * i.coloured)));
    across_ = 0.0;
    across_variance_ = std::max(1.0, i.across * i.across / (i.across_sigma * i.across_sigma));
  }

  void keep_colour(double kept, double added) {
    kept_ *= kept;
    x_[3] *= kept;
    P_.topRightCorner<3, 1>() *= kept;
    P_.bottomLeftCorner<1, 3>() *= kept;
    P_(3, 3) = kept * kept * P_(3, 3) + added;
  }

  void correct(const Eigen::RowVector4d& H, double r, double R) {
    const Eigen::Vector4d PH = P_ * H.transpose();
    const double S = H.dot(PH.transpose()) + R;
    x_ += PH * (r / S);
    P_ -= PH * PH.transpose() / S;
  }

  void speed(double z, double R, bool sure) {
    const Eigen::RowVector4d H(0, 1, 0, 0);
    const double r = z - x_[1], S = P_(1, 1) + R, nu = options_.gnss.nu;
    const double nis = r * r / S;
    if (sure) {
      out_.evidence.speed += log_gauss(r, S);
      correct(H, r, R);
      return;
    }
    out_.evidence.speed += student_.one(nis, S);
    if (nis > options_.gnss.gate) return;
    const double w = std::min(1.0, (nu + 1.0) / (nu + nis));
    correct(H, r, R + S * (1.0 / w - 1.0));
  }

  struct Innovation {
    View v;
    Eigen::RowVector4d H;
    double along, across;  // of the fix from the predicted place, m
    double ra, rc;         // without the correlated errors' predictions
    double Sa, Sc;         // variances of these
    double white, coloured, across_sigma;
  };
  [[nodiscard]] Innovation innovation(const Epoch& e) const {
    const auto& g = options_.gnss;
    Innovation i;
    // Where the distance is not known well, the path is linearised at the fix's foot instead of the prediction.
    const double sigma_d = std::sqrt(P_(0, 0));
    const double at =
        sigma_d < 10.0 ? x_[0] : path_.project(*e.position, x_[0] - 4.0 * sigma_d, x_[0] + 4.0 * sigma_d).distance;
    i.v = view(path_, at, std::min(sigma_d, 10.0), options_);
    const Eigen::Vector2d r = *e.position - i.v.point + i.v.along * (i.v.slope * (at - x_[0]));
    i.along = i.v.along.dot(r), i.across = i.v.across.dot(r);
    i.coloured = std::sqrt(g.correlated) * e.sigma;
    i.white = (1.0 - g.correlated) * e.sigma * e.sigma;
    i.H << i.v.slope, 0, 0, i.coloured;
    i.Sa = (i.H * P_ * i.H.transpose())(0) + i.white;
    // Across the track the map's own error comes on top; both change slowly.
    i.across_sigma = std::hypot(i.coloured, g.map_sigma);
    i.Sc = i.across_sigma * i.across_sigma * across_variance_ + i.white + 1e-4;
    i.ra = i.along - i.coloured * x_[3], i.rc = i.across - i.across_sigma * across_;
    return i;
  }

  /// So far off that the receiver's sigma means nothing.
  [[nodiscard]] bool gross(const Innovation& i, const Epoch& e) const {
    const double variance = e.sigma * e.sigma, map = options_.gnss.map_sigma;
    return i.along * i.along / (variance + P_(0, 0)) + i.across * i.across / (variance + map * map) >
           options_.gnss.gate;
  }

  void position(const Epoch& e, std::size_t k) {
    const auto& g = options_.gnss;
    const Innovation i = innovation(e);
    const auto& [v, H, along, across, ra, rc, Sa, Sc, white, coloured, across_sigma] = innovation(e);
    const double nis = ra * ra / Sa + rc * rc / Sc;

    const std::size_t index = out_.residuals.size();
    double w = std::min(1.0, (g.nu + 2.0) / (g.nu + nis));
    bool gated = gross(i, e);
    if (!weights_.empty()) w = weights_[index], gated = !(w > 0.02);
    out_.evidence.position += student_.two(nis, Sa * Sc);
    if (gated && weights_.empty() && rc * rc < 16.0 * Sc) {
      // Fixes that agree with the track but not with the distance, many in a row: it is the distance that is wrong.
      if (++astray_ >= 10) P_(0, 0) += ra * ra, astray_ = 0;
    } else if (!gated) {
      astray_ = 0;
    }
    out_.residuals.push_back({e.fix, k, float(ra), float(rc), float(std::sqrt(Sa)), float(std::sqrt(Sc)), float(nis),
                              gated ? 0.0F : float(w)});
    if (gated) return;
    correct(H, ra, white + e.sigma * e.sigma * (1.0 / w - 1.0));
    const double R = white + 1e-4 + across_sigma * across_sigma * (1.0 / w - 1.0);
    const double gain = across_variance_ * across_sigma / (across_sigma * across_sigma * across_variance_ + R);
    across_ += gain * rc;
    across_variance_ *= 1.0 - gain * across_sigma;
  }

  /// Turn rate against the map's curvature: the azimuth now minus that where the vehicle was `turn_seconds` ago.
  void turn(const Epoch& e) {
    constexpr double base = 20.0;
    const double dt = e.turn_seconds, back = x_[0] - x_[1] * dt;
    const double r = *e.turn - (path_.azimuth(x_[0], base) - path_.azimuth(back, base));
    const double k1 = path_.curvature(x_[0], base), k0 = path_.curvature(back, base);
    const Eigen::RowVector4d H(k1 - k0, k0 * dt, 0, 0);
    const double R = options_.turn_rate_sigma * options_.turn_rate_sigma;
    const double S = (H * P_ * H.transpose())(0) + R, nu = options_.gnss.nu;
    out_.evidence.turn_rate += student_.one(r * r / S, S);
    const double w = std::min(1.0, (nu + 1.0) / (nu + r * r / S));
    if (r * r < options_.gnss.gate * S) correct(H, r, R + S * (1.0 / w - 1.0));
  }

  const network::PathCoordinates& path_;
  const Epochs& epochs_;
  const Options& options_;
  std::span<const double> weights_;
  LogStudent student_;
  MotionTable table_;
  State4 x_ = State4::Zero();
  Covariance4 P_ = Covariance4::Identity();
  double across_ = 0.0, across_variance_ = 1.0;  // correlated error across, in units of its sigma
  double kept_ = 1.0;                            // share of the correlated error that goes on from the epoch before
  double last_sigma_ = 0.0;                      // of the fix before
  int astray_ = 0;
  Filtered out_;
};

}  // namespace

Filtered filter_on_path(const network::PathCoordinates& path, const Epochs& epochs, const Options& options,
                        std::span<const double> weights) {
  return PathFilter(path, epochs, options, weights).run();
}

void advance(const network::PathCoordinates& path, const Epochs& model, const Options& options, const Epoch& epoch,
             std::int64_t steps, TrackerState& state) {
  PathFilter(path, model, options, {}).advance(epoch, steps, state);
}

std::vector<double> smoothed_weights(const network::PathCoordinates& path, const Epochs& epochs, const Options& options,
                                     const Filtered& filtered, const Smoothed& smoothed) {
  std::vector<double> weights;
  weights.reserve(filtered.residuals.size());
  const auto& g = options.gnss;
  for (const auto& f : filtered.residuals) {
    const Epoch& e = epochs.epochs[f.epoch];
    const State4& x = smoothed.state[f.epoch];
    const View v = view(path, x[0], 0.0, options);
    const Eigen::Vector2d r = *e.position - v.point;
    const double along = v.along.dot(r), across = v.across.dot(r);
    const double Sa = e.sigma * e.sigma + smoothed.covariance[f.epoch](0, 0);
    const double Sc = e.sigma * e.sigma + g.map_sigma * g.map_sigma;
    const double nis = along * along / Sa + across * across / Sc;
    weights.push_back(nis > g.gate ? 0.0 : std::min(1.0, (g.nu + 2.0) / (g.nu + nis)));
  }
  return weights;
}

}  // namespace versine::georef
