// SPDX-License-Identifier: Apache-2.0
#include "versine/design/optimal_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "axis_fit.hpp"
#include "profile_fit.hpp"
#include "versine/design/segmentation.hpp"

namespace versine::design {

namespace {

Expected<void> check(std::span<const TrackSample> samples) {
  if (samples.size() < 20 || !(samples.back().distance - samples.front().distance >= 50.0)) {
    return fail({.field = "optimal axis",
                 .found = fmt::format("{} samples over {:.1f} m", samples.size(),
                                      samples.empty() ? 0.0 : samples.back().distance - samples.front().distance),
                 .expected = "20 samples over 50 m or more",
                 .advice = "survey a longer piece, or give a design"});
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const TrackSample& s = samples[i];
    const bool finite =
        std::isfinite(s.distance) && std::isfinite(s.easting) && std::isfinite(s.northing) && std::isfinite(s.heading);
    if (finite && (i == 0 || s.distance > samples[i - 1].distance)) continue;
    return fail({.line = i + 1,
                 .field = "optimal axis",
                 .found = finite ? "a distance that does not increase" : "a number that is not finite",
                 .expected = "samples in order of distance, without gaps in their values",
                 .advice = "give each uninterrupted piece of the run by itself"});
  }
  return {};
}

/// Every `step` metres one sample.
std::vector<TrackSample> thin(std::span<const TrackSample> samples, double step) {
  std::vector<TrackSample> out;
  double next = samples.front().distance;
  for (const TrackSample& s : samples) {
    if (s.distance < next) continue;
    out.push_back(s);
    next = std::max(next + step, s.distance + 0.5 * step);
  }
  return out;
}

/// Mean of a quantity in cells along the track; an empty cell takes the one before.
template <class Value>
std::vector<double> cells(std::span<const TrackSample> samples, double cell, const Value& value) {
  const double start = samples.front().distance;
  const auto n = static_cast<std::size_t>((samples.back().distance - start) / cell);
  std::vector<double> sum(n, 0.0);
  std::vector<int> count(n, 0);
  for (const TrackSample& s : samples) {
    const auto i = static_cast<std::size_t>((s.distance - start) / cell);
    if (i >= n) continue;
    sum[i] += value(s);
    ++count[i];
  }
  for (std::size_t i = 0; i < n; ++i) sum[i] = count[i] > 0 ? sum[i] / count[i] : i > 0 ? sum[i - 1] : 0.0;
  return sum;
}

/// Headings without jumps of a full turn.
std::vector<TrackSample> unwrapped(std::span<const TrackSample> samples) {
  std::vector<TrackSample> out(samples.begin(), samples.end());
  for (std::size_t i = 1; i < out.size(); ++i) {
    out[i].heading = out[i - 1].heading + std::remainder(out[i].heading - out[i - 1].heading, 2.0 * std::numbers::pi);
  }
  return out;
}

/// A constant piece of the curvature diagram.
struct Plateau {
  double from, to, curvature;
};

/// Lines and arcs of the curvature diagram; what lies between two of them is a transition.
std::vector<Plateau> plateaus(std::span<const TrackSample> samples, const OptimalAxisOptions& o) {
  const std::vector<double> heading = cells(samples, o.cell, [](const TrackSample& s) { return s.heading; });
  const auto shortest = static_cast<std::size_t>(std::max(2.0, std::round(o.shortest / o.cell)));
  const std::vector<Segment> segments = segment(heading, 1, 3.0, std::max<std::size_t>(shortest, 3));
  std::vector<Plateau> out;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    if (!s.ramp) {
      out.push_back({static_cast<double>(s.from) * o.cell, static_cast<double>(s.to) * o.cell, s.level / o.cell});
    } else if (i + 1 < segments.size() && segments[i + 1].ramp && s.to >= 2 && s.to + 1 < heading.size()) {
      // Two ramps, down and up again: the piece between them was too short to be seen.
      const double between = (heading[s.to + 1] - heading[s.to - 2]) / (3.0 * o.cell);
      const double before = s.level / o.cell, after = segments[i + 1].level / o.cell;
      const double low = std::min(before, after), high = std::max(before, after), step = 1.0 / o.straight;
      const double at = static_cast<double>(s.to) * o.cell;
      if (between < low - step || between > high + step) out.push_back({at - 0.3 * o.cell, at + 0.3 * o.cell, between});
    }
  }
  // A transition from right to left may hold no straight piece long enough to be seen: it gets a short one.
  for (std::size_t i = 0; i + 1 < out.size(); ++i) {
    const double smaller = std::min(std::abs(out[i].curvature), std::abs(out[i + 1].curvature));
    const bool reverse = out[i].curvature * out[i + 1].curvature < 0.0 && smaller > 1.0 / o.straight;
    if (!reverse || out[i + 1].from - out[i].to < 4.0 * o.cell) continue;
    const double share = out[i].curvature / (out[i].curvature - out[i + 1].curvature);
    const double middle = out[i].to + share * (out[i + 1].from - out[i].to);
    out.insert(out.begin() + static_cast<std::ptrdiff_t>(i) + 1, {middle - 0.2 * o.cell, middle + 0.2 * o.cell, 0.0});
    ++i;
  }
  const double length = samples.back().distance - samples.front().distance;
  if (out.empty()) {
    const double turn = samples.back().heading - samples.front().heading;
    return {{0.0, length, turn / length}};
  }
  out.front().from = 0.0;
  out.back().to = std::max(length, out.back().from + o.cell);
  return out;
}

Chain seed(std::span<const TrackSample> samples, const std::vector<Plateau>& found, const OptimalAxisOptions& o) {
  Chain chain;
  chain.start = {samples.front().easting, samples.front().northing, 0.0};
  for (std::size_t i = 0; i < found.size(); ++i) {
    double from = found[i].from, to = found[i].to;
    // Neighbours that touch give way to a transition of two cells.
    if (i > 0 && from - found[i - 1].to < o.cell) from += o.cell;
    if (i + 1 < found.size() && found[i + 1].from - to < o.cell) to -= o.cell;
    if (i > 0) {
      const HorizontalElement& last = chain.elements.back();
      double end = 0.0;
      for (const HorizontalElement& e : chain.elements) end += e.length;
      chain.elements.push_back(
          {o.shapes.front(), std::max(from - end, 1.0), last.curvature_end, found[i].curvature, 0.0, ""});
    }
    chain.elements.push_back({Shape::arc, std::max(to - from, 0.5), found[i].curvature, found[i].curvature, 0.0, ""});
  }
  chain.fixed_length.assign(chain.elements.size(), false);
  chain.fixed_curvature.assign(chain.elements.size(), false);
  // The heading at the start fits the first line or arc.
  std::vector<double> heading;
  for (const TrackSample& s : samples) {
    const double u = s.distance - samples.front().distance;
    if (u > std::max(chain.elements.front().length, 10.0)) break;
    heading.push_back(s.heading - u * chain.elements.front().curvature_start);
  }
  const auto middle = heading.begin() + static_cast<std::ptrdiff_t>(heading.size() / 2);
  std::nth_element(heading.begin(), middle, heading.end());
  chain.start.heading = *middle;
  connect(chain);
  return chain;
}

void erase(Chain& chain, std::size_t first, std::size_t count) {
  const auto at = [first](auto& v) { return v.begin() + static_cast<std::ptrdiff_t>(first); };
  const auto n = static_cast<std::ptrdiff_t>(count);
  chain.elements.erase(at(chain.elements), at(chain.elements) + n);
  chain.fixed_length.erase(at(chain.fixed_length), at(chain.fixed_length) + n);
  chain.fixed_curvature.erase(at(chain.fixed_curvature), at(chain.fixed_curvature) + n);
}

/// Drops what the data do not need: plateaus that shrank to nothing, steps of curvature within their noise.
/// True when something was dropped, and the chain must be fitted again.
bool prune(Chain& chain, double noise, double shortest) {
  for (std::size_t i = 2; i + 2 < chain.elements.size(); i += 2) {
    const double before = chain.elements[i - 2].curvature_start, after = chain.elements[i + 2].curvature_start;
    const double own = chain.elements[i].curvature_start;
    // A step on the way from one curvature to the other is no arc when it is short; any other must have shrunk to
    // nothing. At a change of direction the straight point between two transitions stays.
    const bool on_the_way = (own - before) * (after - own) > 0.0 && before * after >= 0.0;
    if (chain.elements[i].length > (on_the_way ? shortest : 0.5) || before * after < 0.0) continue;
    chain.elements[i - 1].length += chain.elements[i].length + chain.elements[i + 1].length;
    erase(chain, i, 2);
    connect(chain);
    return true;
  }
  for (std::size_t i = 1; i + 1 < chain.elements.size(); i += 2) {
    const HorizontalElement &a = chain.elements[i - 1], &b = chain.elements[i + 1];
    const double step = b.curvature_start - a.curvature_start;
    // What the step does to the far end of the shorter neighbour: less than the noise can't be seen.
    const double reach = std::min(a.length, b.length) + chain.elements[i].length;
    if (std::abs(step) * reach * reach / 8.0 > 2.0 * noise) continue;
    const double total = a.length + b.length;
    chain.elements[i - 1].curvature_start = (a.curvature_start * a.length + b.curvature_start * b.length) / total;
    chain.elements[i - 1].length = total + chain.elements[i].length;
    erase(chain, i, 2);
    connect(chain);
    return true;
  }
  return false;
}

/// Large radii that deviate from a straight by less than the noise become straights.
bool straighten(Chain& chain, double noise, double radius) {
  bool changed = false;
  for (std::size_t i = 0; i < chain.elements.size(); i += 2) {
    HorizontalElement& e = chain.elements[i];
    if (chain.fixed_curvature[i] || std::abs(e.curvature_start) > 1.0 / radius) continue;
    if (std::abs(e.curvature_start) * e.length * e.length / 8.0 > 2.0 * noise) continue;
    e.curvature_start = 0.0;
    chain.fixed_curvature[i] = changed = true;
  }
  connect(chain);
  return changed;
}

double squares_near(const ChainFit& fit, double from, double to, double offset_sigma, double heading_sigma) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < fit.offset.size(); ++i) {
    const double s = fit.distance[static_cast<std::size_t>(i)];
    if (s < from || s > to) continue;
    // Bounded, so that an outlier does not choose.
    const double a = fit.offset[i] / offset_sigma, b = fit.heading[i] / heading_sigma;
    sum += std::min(a * a, 9.0) + std::min(b * b, 9.0);
  }
  return sum;
}

double rms(const Eigen::VectorXd& v) {
  return std::sqrt(v.squaredNorm() / static_cast<double>(v.size()));
}

/// How much smaller the sum of squares of another kind of transition must be. Ten neighbouring residuals count as about
/// one, so this is an odds of e^2; measured on 1 mm of irregularity, true differences are 100 to 500, and where it is
/// below 40 (short, flat transitions) the lengths of both kinds describe the track equally well.
constexpr double convincing = 40.0;

/// Fits the chain once with each kind of transition, and keeps for each transition the kind with the least residuals,
/// the usual one when the difference does not convince. `evidence` receives that difference per element.
ChainFit choose_shapes(const ChainFit& first, std::span<const TrackSample> samples, const OptimalAxisOptions& o,
                       std::vector<double>& evidence) {
  evidence.assign(first.chain.elements.size(), 0.0);
  if (o.shapes.size() < 2 || first.chain.elements.size() < 3) return first;
  std::vector<ChainFit> fits = {first};
  for (std::size_t k = 1; k < o.shapes.size(); ++k) {
    Chain chain = first.chain;
    for (std::size_t i = 1; i < chain.elements.size(); i += 2) {
      chain.elements[i].shape = o.shapes[k];
      // The smooth kinds are steeper in the middle: about as much longer.
      chain.elements[i].length *= o.shapes[k] == Shape::clothoid ? 1.0 : 1.3;
      const double longer = chain.elements[i].length - first.chain.elements[i].length;
      for (const std::size_t side : {i - 1, i + 1}) {
        chain.elements[side].length = std::max(chain.elements[side].length - 0.5 * longer, 1.0);
      }
    }
    fits.push_back(fit_chain(chain, samples, o.huber, false));
  }
  double offset_sigma = 1e9, heading_sigma = 1e9;
  for (const ChainFit& f : fits) {
    offset_sigma = std::min(offset_sigma, rms(f.offset));
    heading_sigma = std::min(heading_sigma, rms(f.heading));
  }
  Chain mixed = first.chain;
  bool changed = false;
  double from = 0.0;
  for (std::size_t i = 0; i < mixed.elements.size(); ++i) {
    const double length = first.chain.elements[i].length;
    if (i % 2 == 1) {
      const double margin = 0.5 * length;
      std::vector<double> squares;
      for (const ChainFit& f : fits) {
        squares.push_back(squares_near(f, from - margin, from + length + margin, offset_sigma, heading_sigma));
      }
      const auto other =
          static_cast<std::size_t>(std::min_element(squares.begin() + 1, squares.end()) - squares.begin());
      evidence[i] = std::abs(squares[0] - squares[other]);
      if (const std::size_t best = squares[0] - squares[other] > convincing ? other : 0; best > 0) {
        mixed.elements[i] = fits[best].chain.elements[i];
        const double longer = mixed.elements[i].length - length;
        for (const std::size_t side : {i - 1, i + 1}) {
          mixed.elements[side].length = std::max(mixed.elements[side].length - 0.5 * longer, 1.0);
        }
        changed = true;
      }
    }
    from += length;
  }
  connect(mixed);
  return changed ? fit_chain(mixed, samples, o.huber, false) : first;
}

void round_values(Chain& chain, const OptimalAxisOptions& o) {
  for (std::size_t i = 0; i < chain.elements.size(); ++i) {
    HorizontalElement& e = chain.elements[i];
    if (i % 2 == 0 && o.round_radius > 0.0 && e.curvature_start != 0.0) {
      const double radius = std::max(std::round(1.0 / std::abs(e.curvature_start) / o.round_radius), 1.0);
      e.curvature_start = std::copysign(1.0 / (radius * o.round_radius), e.curvature_start);
      chain.fixed_curvature[i] = true;
    }
    if (i % 2 == 1 && o.round_length > 0.0) {
      e.length = std::max(std::round(e.length / o.round_length), 1.0) * o.round_length;
      chain.fixed_length[i] = true;
    }
  }
  connect(chain);
}

std::vector<ElementSigma> sigmas(const ChainFit& fit) {
  std::vector<ElementSigma> out(fit.chain.elements.size());
  // A joint's distance is the sum of the lengths before it.
  Eigen::VectorXd joint = Eigen::VectorXd::Zero(fit.covariance.rows());
  const auto sigma = [&](const Eigen::VectorXd& row) {
    return std::sqrt(std::max(row.dot(fit.covariance * row), 0.0));
  };
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].joint = sigma(joint);
    if (const int k = fit.length_index[i]; k >= 0) {
      out[i].length = std::sqrt(fit.covariance(k, k));
      joint[k] += 1.0;
    }
    if (const int k = fit.curvature_index[i]; k >= 0) out[i].curvature = std::sqrt(fit.covariance(k, k));
  }
  return out;
}

/// The last element ends where the track ends.
void trim_end(ChainFit& fit) {
  double before = 0.0;
  for (std::size_t i = 0; i + 1 < fit.chain.elements.size(); ++i) before += fit.chain.elements[i].length;
  fit.chain.elements.back().length = std::max(fit.distance.back() - before, 0.05);
}

}  // namespace

Expected<OptimalAxis> optimal_axis(std::span<const TrackSample> all, const OptimalAxisOptions& options) {
  if (auto good = check(all); !good) return tl::unexpected(good.error());
  const std::vector<TrackSample> whole = unwrapped(all);
  const std::vector<TrackSample> samples = thin(whole, options.step);
  ChainFit fit = fit_chain(seed(samples, plateaus(whole, options), options), samples, options.huber, false);
  for (int round = 0; round < 50 && prune(fit.chain, rms(fit.offset), options.shortest); ++round) {
    trim_end(fit);
    fit = fit_chain(fit.chain, samples, options.huber, false);
  }
  trim_end(fit);
  std::vector<double> evidence;
  fit = choose_shapes(fit, samples, options, evidence);
  if (straighten(fit.chain, rms(fit.offset), options.straight)) {
    fit = fit_chain(fit.chain, samples, options.huber, false);
  }
  if (options.round_radius > 0.0 || options.round_length > 0.0) round_values(fit.chain, options);
  trim_end(fit);
  fit = fit_chain(fit.chain, samples, options.huber, true);
  trim_end(fit);

  OptimalAxis out;
  auto axis = HorizontalAxis::chain(fit.chain.start, fit.chain.elements);
  if (!axis) return tl::unexpected(axis.error());
  out.alignment.horizontal = *std::move(axis);
  out.alignment.name = "optimal axis";
  out.sigma = sigmas(fit);
  for (std::size_t i = 0; i < evidence.size(); ++i) out.sigma[i].kind_certain = evidence[i] > convincing;
  out.covariance = fit.covariance;
  out.unknowns = fit.unknowns;
  out.offset_rms = rms(fit.offset);
  out.heading_rms = rms(fit.heading);
  out.outliers = fit.outliers;
  fit_cant(samples, fit.distance, options.huber, out);
  if (auto profile = fit_profile(samples, fit.distance, options, out); !profile) return tl::unexpected(profile.error());
  return out;
}

}  // namespace versine::design
