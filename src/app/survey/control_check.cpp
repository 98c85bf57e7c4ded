// SPDX-License-Identifier: Apache-2.0
#include "versine/app/control_check.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "versine/geodesy/attitude.hpp"

namespace versine::app {
namespace {

using stationing::StationFigure;

constexpr std::size_t longest_figure = 12;  // its covariance costs the square of it
constexpr double weak = 0.05;               // m: places the trajectory, and says nothing of its figure
constexpr double floor_sigma = 5e-5;        // m: what the error chain's single precision leaves

/// The instrument at one time: place, and how its error follows from the six of the chain.
struct Moment {
  std::string name;
  std::size_t epoch;
  Eigen::Vector3d position;
  Eigen::Matrix<double, 3, 6> by_error;  // m-frame
};

std::optional<Moment> moment_at(const fusion::Solution& s, const sensors::LandmarkSample& l,
                                const Eigen::Vector3d& lever_b, const geodesy::LocalFrame& frame) {
  const auto& track = s.smoothed;
  const std::size_t i = track.empty() ? 0 : track.lower_bound(l.time);
  if (i >= track.size() || s.chain.empty()) return {};
  const auto& p = track[i];
  // The trolley stands: an epoch half a second away is as good.
  const std::size_t epoch = s.chain.index_at(l.time);
  if (!(std::abs((s.chain.time(epoch) - l.time).seconds()) < 2.0 && std::abs((p.time - l.time).seconds()) < 2.0)) {
    return {};
  }
  const Eigen::Vector3d arm = p.q_nb * lever_b;
  const Eigen::Matrix3d to_m = frame.rotation_from(p.position);
  Moment m{.name = l.name, .epoch = epoch, .position = frame.to_ned(p.position) + to_m * arm};
  m.by_error << to_m, to_m * geodesy::skew(arm);
  return m;
}

StationFigure figure_of(std::span<const Moment> moments, const filter::ErrorChain& chain) {
  StationFigure f;
  const auto n = static_cast<Eigen::Index>(3 * moments.size());
  f.covariance = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    f.stations.push_back(moments[i].name);
    f.positions.push_back(moments[i].position);
    for (std::size_t j = i; j < moments.size(); ++j) {
      const Eigen::Matrix3d c = moments[i].by_error * chain.cross_covariance(moments[i].epoch, moments[j].epoch) *
                                moments[j].by_error.transpose();
      const auto a = static_cast<Eigen::Index>(3 * i), b = static_cast<Eigen::Index>(3 * j);
      f.covariance.block<3, 3>(a, b) += i == j ? Eigen::Matrix3d(0.5 * (c + c.transpose())) : c;
      if (i != j) f.covariance.block<3, 3>(b, a) += c.transpose();
    }
  }
  // Rounding over hundreds of epochs leaves directions of slightly negative variance, at 0.1 mm.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(f.covariance);
  const Eigen::VectorXd variances = parts.eigenvalues().array().max(0.0) + floor_sigma * floor_sigma;
  f.covariance = parts.eigenvectors() * variances.asDiagonal() * parts.eigenvectors().transpose();
  return f;
}

}  // namespace

std::vector<StationFigure> station_figures(const fusion::Solution& solution,
                                           const std::vector<sensors::LandmarkSample>& landmarks,
                                           const Eigen::Vector3d& lever_b, const geodesy::LocalFrame& frame) {
  std::vector<Moment> moments;
  for (const auto& l : landmarks) {
    if (auto m = moment_at(solution, l, lever_b, frame)) moments.push_back(std::move(*m));
  }
  std::vector<StationFigure> figures;
  for (std::size_t i = 0; i < moments.size(); i += longest_figure) {
    const auto part = std::span(moments).subspan(i, std::min(longest_figure, moments.size() - i));
    if (part.size() > 1) figures.push_back(figure_of(part, solution.chain));
  }
  return figures;
}

Expected<ControlCheck> check_control(const StationingOutcome& stations, const StationingProcessing& processing,
                                     fusion::AidedInsInput input, fusion::AidedInsOptions options, Progress& progress,
                                     Log& log) {
  std::vector<StationFigure> figures;
  if (processing.arrangement == StationingProcessing::Arrangement::on_trolley) {
    for (auto& l : input.landmarks.samples) {
      l.covariance += weak * weak * Eigen::Matrix3d::Identity();
      l.shared.reset();  // the control points' errors are unknowns of the network
      l.q_ns.reset();
    }
    options.chain_rate = 1.0;
    const auto solved = fusion::run_aided_ins(input, options, progress, log);
    if (!solved) return tl::unexpected(solved.error());
    figures = station_figures(solved->solution, stations.landmarks, options.landmark_lever.l_b, stations.frame);
  }
  // What could not be computed alone would make the network fall apart.
  std::vector<stationing::ReducedStation> solved;
  for (const auto& r : stations.reduced) {
    const auto same = [&](const stationing::StationResult& s) { return s.name == r.name; };
    if (std::any_of(stations.run.stations.begin(), stations.run.stations.end(), same)) solved.push_back(r);
  }
  auto network = stationing::adjust_network(
      solved, stations.network, processing.instrument,
      {.tilt_sigma = processing.options.tilt_sigma, .significance = processing.options.significance}, figures);
  if (!network) return tl::unexpected(network.error());
  ControlCheck check{.network = std::move(*network)};
  for (const auto& p : check.network.points) {
    if (!p.moved) continue;
    check.record.warnings.push_back(fmt::format(
        "control point {} has moved since its survey by {:.1f} mm north, {:.1f} mm east, {:.1f} mm down, by all "
        "stations and the trajectory together",
        p.name, p.offset->x() * 1e3, p.offset->y() * 1e3, p.offset->z() * 1e3));
  }
  return check;
}

}  // namespace versine::app
