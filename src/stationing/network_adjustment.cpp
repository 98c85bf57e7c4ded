// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/network_adjustment.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <set>

#include "network_solver.hpp"
#include "statistics.hpp"

namespace versine::stationing {
namespace {

class Network {
 public:
  Network(NetworkModel model, const Instrument& instrument, const NetworkOptions& options,
          std::span<const StationFigure> figures)
      : model_(std::move(model)),
        context_{instrument, options, figures},
        options_(options),
        critical_(chi_square_quantile(3, options.significance)) {}

  Expected<NetworkResult> run() {
    if (auto ok = check_figures(); !ok) return tl::unexpected(ok.error());
    for (const bool robust : {true, false}) solve_network(model_, context_, robust, o_);
    for (int round = 0; options_.snoop && round < 200; ++round) {
      if (auto ok = determined(); !ok) return tl::unexpected(ok.error());
      test();
      if (!leave_out_worst()) break;
      solve_network(model_, context_, false, o_);
    }
    if (auto ok = determined(); !ok) return tl::unexpected(ok.error());
    test();
    return result();
  }

 private:
  Expected<void> determined() const {
    if (o_.normal.info() == Eigen::Success && o_.redundancy > 0) return {};
    return fail({.field = "network adjustment",
                 .found = fmt::format("{} redundant observations", o_.redundancy),
                 .expected = "more observations than unknowns, and points that determine every station",
                 .advice = "measure more common points"});
  }

  Expected<void> check_figures() const {
    for (const StationFigure& f : context_.figures) {
      std::set<std::size_t> marks;
      for (const std::string& name : f.stations) {
        const auto station = station_named(model_, name);
        if (!station || !marks.insert(model_.stations[*station].mark).second) {
          return fail({.field = "figure of stations",
                       .found = fmt::format("station '{}'{}", name, station ? " twice" : ""),
                       .expected = "stations of the network, each once",
                       .advice = "remove the station from the figure"});
        }
      }
      const auto n = static_cast<Eigen::Index>(3 * f.stations.size());
      if (f.positions.size() != f.stations.size() || f.covariance.rows() != n || f.covariance.cols() != n ||
          f.covariance.llt().info() != Eigen::Success) {
        return fail({.field = "figure of stations",
                     .found = fmt::format("{} stations, {} positions, a covariance of {} rows", f.stations.size(),
                                          f.positions.size(), f.covariance.rows()),
                     .expected = "a position and three positive definite rows for each",
                     .advice = "give the joint covariance of the trajectory at the stations"});
      }
    }
    return {};
  }

  /// I - J N^-1 J' of three rows.
  Eigen::Matrix3d redundancy_block(std::size_t row) const {
    const Sparse j = o_.jacobian.middleRows(static_cast<Eigen::Index>(row), 3);
    const Eigen::MatrixXd jt = Eigen::MatrixXd(j.transpose());
    return Eigen::Matrix3d::Identity() - j * o_.normal.solve(jt);
  }

  double block_test(std::size_t row, const Eigen::Matrix3d& block) const {
    const Eigen::Vector3d v = o_.residuals.segment<3>(static_cast<Eigen::Index>(row));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(block);
    double test = 0.0;
    for (int k = 0; k < 3; ++k) {
      if (eigen.eigenvalues()(k) > 1e-6)
        test += std::pow(eigen.eigenvectors().col(k).dot(v), 2) / eigen.eigenvalues()(k);
    }
    return test;
  }

  void test() {
    residuals_.clear();
    control_test_.assign(model_.positions.size(), 0.0);
    for (std::size_t k = 0; k < model_.sightings.size(); ++k) {
      const NetworkSighting& s = model_.sightings[k];
      NetworkResidual r{.station = model_.stations[s.station].readings->name,
                        .point = model_.names[s.point],
                        .sigma = sighting_sigma(*s.target, context_.instrument),
                        .used = s.used};
      if (s.used) {
        const Eigen::Matrix3d block = redundancy_block(o_.sighting_row[k]);
        r.residual = o_.residuals.segment<3>(static_cast<Eigen::Index>(o_.sighting_row[k])).cwiseProduct(r.sigma);
        r.redundancy = block.diagonal();
        r.test = block_test(o_.sighting_row[k], block);
      }
      residuals_.push_back(std::move(r));
    }
    for (std::size_t i = 0; i < model_.positions.size(); ++i) {
      if (model_.held[i]) control_test_[i] = block_test(o_.control_row[i], redundancy_block(o_.control_row[i]));
    }
  }

  bool leave_out_worst() {
    double worst = critical_;
    std::size_t sighting = npos, control = npos;
    for (std::size_t k = 0; k < residuals_.size(); ++k) {
      if (residuals_[k].used && residuals_[k].test > worst) worst = residuals_[k].test, sighting = k;
    }
    for (std::size_t i = 0; i < control_test_.size(); ++i) {
      if (control_test_[i] > worst) worst = control_test_[i], control = i, sighting = npos;
    }
    if (control != npos) model_.held[control] = false;
    if (sighting != npos) model_.sightings[sighting].used = false;
    return control != npos || sighting != npos;
  }

  Eigen::Matrix<double, 6, 6> covariance_of(std::size_t first, std::size_t second) const {
    Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(o_.jacobian.cols(), 6);
    for (int k = 0; k < 3; ++k) {
      rhs(static_cast<Eigen::Index>(first) + k, k) = 1.0;
      rhs(static_cast<Eigen::Index>(second) + k, 3 + k) = 1.0;
    }
    const Eigen::MatrixXd x = o_.normal.solve(rhs);
    Eigen::Matrix<double, 6, 6> c;
    c << x.middleRows<3>(static_cast<Eigen::Index>(first)), x.middleRows<3>(static_cast<Eigen::Index>(second));
    return c;
  }

  NetworkResult result() {
    NetworkResult out{.residuals = residuals_, .redundancy = o_.redundancy};
    out.sigma0 = std::sqrt(o_.squares / o_.redundancy);
    const std::size_t n = model_.positions.size();
    for (std::size_t i = 0; i < n; ++i) {
      AdjustedPoint p{.name = model_.names[i], .position = model_.positions[i], .control_test = control_test_[i]};
      p.covariance = covariance_of(3 * i, 3 * i).topLeftCorner<3, 3>();
      if (model_.control[i] != nullptr) {
        p.offset = p.position - model_.control[i]->position;
        p.moved = !options_.free && !model_.held[i];
      }
      out.points.push_back(std::move(p));
    }
    for (std::size_t i = 0; i < model_.stations.size(); ++i) {
      const NetworkStation& s = model_.stations[i];
      StationResult r{.name = s.readings->name, .from = s.readings->from, .to = s.readings->to};
      r.position = model_.positions[s.mark] + s.height * up_at(model_.positions[s.mark]);
      r.q_ms = s.q_ms;
      r.covariance.topLeftCorner<6, 6>() = covariance_of(3 * s.mark, 3 * (n + i));
      r.sigma0 = out.sigma0;
      out.stations.push_back(std::move(r));
    }
    return out;
  }

  NetworkModel model_;
  NetworkContext context_;
  const NetworkOptions& options_;
  double critical_;
  NetworkOutcome o_;
  std::vector<NetworkResidual> residuals_;
  std::vector<double> control_test_;
};

}  // namespace

Expected<NetworkResult> adjust_network(std::span<const ReducedStation> stations, const ControlNetwork& control,
                                       const Instrument& instrument, const NetworkOptions& options,
                                       std::span<const StationFigure> figures) {
  auto model = build_network(stations, control, options);
  if (!model) return tl::unexpected(model.error());
  return Network(std::move(*model), instrument, options, figures).run();
}

}  // namespace versine::stationing
