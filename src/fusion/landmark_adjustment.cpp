// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_adjustment.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "versine/core/numbers.hpp"

namespace versine::fusion::landmark {

namespace {

/// Residuals of landmarks whose redundancy is below this say more about rounding than about the landmark.
constexpr double least_redundancy = 1e-3;

template <int N, int M>
using ForwardSpan = std::span<const filter::ForwardEpoch<N, M>>;

/// Steps `from + 1` to `to` as one.
template <class Step>
Step compressed(std::span<const Step> steps, std::size_t from, std::size_t to) {
  Step all;
  for (std::size_t k = from + 1; k <= to; ++k) {
    all.noise = steps[k].transition * all.noise * steps[k].transition.transpose() + steps[k].noise;
    all.transition = steps[k].transition * all.transition;
  }
  return all;
}

/// The chain node 0, tie 0, tie 1, ...; a tie at the node of the one before makes a step that stands still.
template <class Step>
std::vector<Step> tie_chain(std::span<const Step> steps, std::span<const Tie> ties) {
  std::vector<Step> chain(1);
  std::size_t last = 0;
  for (const Tie& tie : ties) {
    chain.push_back(compressed(steps, last, tie.node));
    last = tie.node;
  }
  return chain;
}

void observe(std::span<VerticalStep> vertical, std::span<LevelStep> level, std::span<const Tie> ties,
             std::span<const Fit> fits) {
  for (std::size_t i = 0; i < ties.size(); ++i) {
    const Tie& tie = ties[i];
    const bool used = fits.empty() || fits[i].used;
    vertical[i + 1].observation.reset();
    level[i + 1].observation.reset();
    if (!used) continue;
    vertical[i + 1].observation = observe_down(tie.misclosure.z(), tie.covariance(2, 2));
    level[i + 1].observation = observe_level(tie.misclosure.head<2>(), tie.covariance.topLeftCorner<2, 2>());
  }
}

/// Joins an observation of the same quantity at the same epoch: their weighted mean.
template <int N, int M>
void join(std::optional<filter::LinearObservation<N, M>>& have, const filter::LinearObservation<N, M>& more) {
  if (!have) {
    have = more;
    return;
  }
  const Eigen::Matrix<double, M, M> gain = have->R * (have->R + more.R).inverse();
  have->z += gain * (more.z - have->z);
  have->R -= gain * Eigen::Matrix<double, M, M>(have->R);
}

template <int N, int M>
std::vector<filter::SmoothedEpoch<N>> smoothed(const filter::Estimate<N>& start,
                                               const std::vector<filter::LinearStep<N, M>>& steps,
                                               std::vector<filter::ForwardEpoch<N, M>>& forward,
                                               LandmarkSmoother smoother) {
  const std::span<const filter::LinearStep<N, M>> span(steps);
  forward = filter::filter_forward(start, span);
  return smoother == LandmarkSmoother::rts ? filter::smooth_rts(span, ForwardSpan<N, M>(forward))
                                           : filter::smooth_two_filter(span, ForwardSpan<N, M>(forward));
}

/// Square root of r' S^-1 r with S the covariance of the residual: R - H P H' for a landmark that was used (its own
/// share is in P), R + H P H' for one that was not.
template <int M>
double normalised(const Eigen::Matrix<double, M, 1>& r, const Eigen::Matrix<double, M, M>& S) {
  const Eigen::LLT<Eigen::Matrix<double, M, M>> llt(S);
  return llt.info() == Eigen::Success ? std::sqrt(r.dot(llt.solve(r))) : 0.0;
}

}  // namespace

Channels build_channels(std::span<const Node> nodes, std::span<const Stretch> stretches, const Prior& prior,
                        const DrivingNoise& noise) {
  Channels c;
  c.vertical.resize(nodes.size());
  c.level.resize(nodes.size());
  for (const Stretch& s : stretches) {
    for (std::size_t k = s.first + 1; k <= s.last; ++k) {
      c.vertical[k] = vertical_step(nodes[k].motion, noise, s.noise);
      c.level[k] = level_step(nodes[k].motion, noise, s.noise);
    }
  }
  const double r = square(prior.position), w = square(prior.bias);
  c.vertical_start.covariance.diagonal() << r, square(prior.pitch), w;
  c.level_start.covariance.diagonal() << r, r, square(prior.scale), square(prior.heading), w;
  return c;
}

std::vector<Fit> snoop(const Channels& channels, std::span<const Tie> ties, double gate) {
  std::vector<Fit> fits(ties.size());
  auto vertical = tie_chain<VerticalStep>(channels.vertical, ties);
  auto level = tie_chain<LevelStep>(channels.level, ties);
  std::vector<filter::ForwardEpoch<vertical::size, 1>> vf;
  std::vector<filter::ForwardEpoch<level::size, 2>> lf;
  while (true) {
    observe(vertical, level, ties, fits);
    const auto vs = smoothed(channels.vertical_start, vertical, vf, LandmarkSmoother::rts);
    const auto ls = smoothed(channels.level_start, level, lf, LandmarkSmoother::rts);
    std::size_t worst = ties.size();
    for (std::size_t i = 0; i < ties.size(); ++i) {
      const auto& ve = vs[i + 1].estimate;
      const auto& le = ls[i + 1].estimate;
      const double sign = fits[i].used ? -1.0 : 1.0;
      const Eigen::Matrix2d R = ties[i].covariance.topLeftCorner<2, 2>();
      const Eigen::Matrix2d S = R + sign * le.covariance.topLeftCorner<2, 2>();
      const double Rv = ties[i].covariance(2, 2), Sv = Rv + sign * ve.covariance(0, 0);
      const Eigen::Vector2d r = ties[i].misclosure.head<2>() - le.mean.head<2>();
      const Eigen::Matrix<double, 1, 1> rv(ties[i].misclosure.z() - ve.mean(0));
      const double horizontal_redundancy = S.trace() / R.trace(), vertical_redundancy = Sv / Rv;
      fits[i].redundancy = std::min(horizontal_redundancy, vertical_redundancy);
      fits[i].horizontal = horizontal_redundancy > least_redundancy ? normalised<2>(r, S) : 0.0;
      fits[i].vertical =
          vertical_redundancy > least_redundancy ? normalised<1>(rv, Eigen::Matrix<double, 1, 1>(Sv)) : 0.0;
      if (fits[i].used && fits[i].worst() > gate && (worst == ties.size() || fits[i].worst() > fits[worst].worst())) {
        worst = i;
      }
    }
    if (worst == ties.size()) return fits;
    fits[worst].used = false;
  }
}

AtTies smooth_at_ties(const Channels& channels, std::span<const Tie> ties, std::span<const Fit> fits) {
  auto vertical = tie_chain<VerticalStep>(channels.vertical, ties);
  auto level = tie_chain<LevelStep>(channels.level, ties);
  observe(vertical, level, ties, fits);
  std::vector<filter::ForwardEpoch<vertical::size, 1>> vf;
  std::vector<filter::ForwardEpoch<level::size, 2>> lf;
  AtTies at;
  at.vertical = smoothed(channels.vertical_start, vertical, vf, LandmarkSmoother::rts);
  at.level = smoothed(channels.level_start, level, lf, LandmarkSmoother::rts);
  at.vertical_start = at.vertical.front().estimate;
  at.level_start = at.level.front().estimate;
  at.vertical.erase(at.vertical.begin());
  at.level.erase(at.level.begin());
  return at;
}

std::vector<filter::SmoothedEpoch<roll::size>> smooth_roll(std::span<const Node> nodes, const Prior& prior,
                                                           const DrivingNoise& noise, std::span<const RollTie> ties,
                                                           LandmarkSmoother smoother) {
  std::vector<RollStep> steps(nodes.size());
  for (std::size_t k = 1; k < nodes.size(); ++k) steps[k] = roll_step(nodes[k].duration, noise);
  for (const RollTie& tie : ties) join(steps[tie.node].observation, observe_roll(tie.difference, tie.variance));
  // The start was levelled by the accelerometers: its roll error is minus theirs (and a little of its own).
  const double b = square(prior.roll);
  RollEstimate start;
  start.covariance.diagonal() << b * (1.0 + 1e-4), square(prior.bias), b;
  start.covariance(roll::angle, roll::levelling) = start.covariance(roll::levelling, roll::angle) = -b;
  std::vector<filter::ForwardEpoch<roll::size, 1>> forward;
  return smoothed(start, steps, forward, smoother);
}

Smoothed smooth(Channels channels, std::span<const Tie> ties, std::span<const Fit> fits,
                std::vector<filter::SmoothedEpoch<roll::size>> roll, LandmarkSmoother smoother) {
  for (std::size_t i = 0; i < ties.size(); ++i) {
    if (!fits[i].used) continue;
    join(channels.vertical[ties[i].node].observation, observe_down(ties[i].misclosure.z(), ties[i].covariance(2, 2)));
    join(channels.level[ties[i].node].observation,
         observe_level(ties[i].misclosure.head<2>(), ties[i].covariance.topLeftCorner<2, 2>()));
  }

  std::vector<filter::ForwardEpoch<vertical::size, 1>> vf;
  std::vector<filter::ForwardEpoch<level::size, 2>> lf;
  Smoothed s;
  s.vertical = smoothed(channels.vertical_start, channels.vertical, vf, smoother);
  s.level = smoothed(channels.level_start, channels.level, lf, smoother);
  s.roll = std::move(roll);
  for (std::size_t i = 0; i < ties.size(); ++i) {
    const auto& pv = vf[ties[i].node].predicted;
    const auto& pl = lf[ties[i].node].predicted;
    const double Sv = pv.covariance(0, 0) + ties[i].covariance(2, 2);
    const Eigen::Matrix2d Sl = pl.covariance.topLeftCorner<2, 2>() + ties[i].covariance.topLeftCorner<2, 2>();
    ForwardInnovation in{.landmark = ties[i].landmark};
    in.value << ties[i].misclosure.head<2>() - pl.mean.head<2>(), ties[i].misclosure.z() - pv.mean(0);
    in.sigma << Sl.diagonal().cwiseSqrt(), std::sqrt(Sv);
    in.nis = in.value.head<2>().dot(Sl.llt().solve(in.value.head<2>())) + square(in.value.z()) / Sv;
    s.innovations.push_back(in);
  }
  return s;
}

}  // namespace versine::fusion::landmark
