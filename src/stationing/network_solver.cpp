// SPDX-License-Identifier: Apache-2.0
#include "network_solver.hpp"

#include <ceres/autodiff_cost_function.h>
#include <ceres/crs_matrix.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>

#include "network_residuals.hpp"
#include "versine/geodesy/attitude.hpp"

namespace versine::stationing {
namespace {

Eigen::Matrix3d whitening_of(const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d w = Eigen::Matrix3d::Identity();
  covariance.llt().matrixL().solveInPlace(w);
  return w;
}

class NetworkSolver {
 public:
  NetworkSolver(NetworkModel& model, const NetworkContext& context, NetworkOutcome& outcome)
      : model_(model), context_(context), o_(outcome) {}

  void solve(bool robust) {
    std::vector<double> theta(3 * model_.stations.size(), 0.0);
    ceres::Problem problem;
    for (auto& p : model_.positions) problem.AddParameterBlock(p.data(), 3);
    for (std::size_t i = 0; i < model_.stations.size(); ++i) problem.AddParameterBlock(&theta[3 * i], 3);
    const std::size_t anchor = add_residuals(problem, theta, robust);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-14;
    options.parameter_tolerance = 1e-13;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!robust) evaluate(problem, theta, anchor);
    for (std::size_t i = 0; i < model_.stations.size(); ++i) {
      auto& q = model_.stations[i].q_ms;
      q = (geodesy::from_rotation_vector(Eigen::Map<Eigen::Vector3d>(&theta[3 * i])) * q).normalized();
    }
  }

 private:
  SightingResidual residual_of(const NetworkSighting& s) const {
    const NetworkStation& station = model_.stations[s.station];
    const Eigen::Vector3d &a = model_.positions[station.mark], &b = model_.positions[s.point];
    return {station.q_ms,
            s.target->target_height * up_at(b) - station.height * up_at(a),
            {s.target->direction, s.target->zenith, s.target->distance},
            sighting_sigma(*s.target, context_.instrument)};
  }

  /// Adds all observations; returns the rows that belong to observations (the rows behind them only hold a free
  /// network in place: 1 m to the start values, so weak that it does not bend the shape).
  std::size_t add_residuals(ceres::Problem& problem, std::vector<double>& theta, bool robust) {
    std::size_t row = 0;
    o_.sighting_row.assign(model_.sightings.size(), npos);
    o_.control_row.assign(model_.positions.size(), npos);
    for (std::size_t k = 0; k < model_.sightings.size(); ++k) {
      const NetworkSighting& s = model_.sightings[k];
      if (!s.used) continue;
      o_.sighting_row[k] = row;
      row += 3;
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<SightingResidual, 3, 3, 3, 3>(new SightingResidual(residual_of(s))),
          robust ? new ceres::CauchyLoss(2.5) : nullptr, model_.positions[model_.stations[s.station].mark].data(),
          &theta[3 * s.station], model_.positions[s.point].data());
    }
    for (std::size_t i = 0; i < model_.positions.size(); ++i) {
      if (!model_.held[i]) continue;
      o_.control_row[i] = row;
      row += 3;
      // A point given as exact is held to a hundredth of a millimetre.
      const Eigen::Matrix3d c = model_.control[i]->covariance + 1e-10 * Eigen::Matrix3d::Identity();
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PositionResidual, 3, 3>(
                                   new PositionResidual{model_.control[i]->position, whitening_of(c)}),
                               robust ? new ceres::CauchyLoss(2.5) : nullptr, model_.positions[i].data());
    }
    for (const StationFigure& figure : context_.figures) {
      std::vector<double*> marks;
      Eigen::VectorXd given(static_cast<Eigen::Index>(3 * figure.stations.size()));
      for (std::size_t i = 0; i < figure.stations.size(); ++i) {
        const NetworkStation& s = model_.stations[*station_named(model_, figure.stations[i])];
        marks.push_back(model_.positions[s.mark].data());
        given.segment<3>(static_cast<Eigen::Index>(3 * i)) =
            figure.positions[i] - s.height * up_at(model_.positions[s.mark]);
      }
      row += 3 * figure.stations.size();
      problem.AddResidualBlock(new FigureCost(given, figure.covariance), nullptr, marks);
    }
    for (std::size_t i = 0; context_.options.tilt_sigma && i < model_.stations.size(); ++i) {
      row += 2;
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<LevelResidual, 2, 3>(new LevelResidual{
              model_.stations[i].q_ms, up_at(model_.positions[model_.stations[i].mark]), *context_.options.tilt_sigma}),
          nullptr, &theta[3 * i]);
    }
    if (is_free()) {
      for (auto& p : model_.positions) {
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PositionResidual, 3, 3>(
                                     new PositionResidual{p, Eigen::Matrix3d::Identity()}),
                                 nullptr, p.data());
      }
    }
    return row;
  }

  bool is_free() const {
    return std::none_of(model_.held.begin(), model_.held.end(), [](bool h) { return h; });
  }

  /// Inner constraints: small translations and rotations of all points together, as rows on the points' columns.
  Eigen::MatrixXd datum_rows() const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : model_.positions) mean += p / static_cast<double>(model_.positions.size());
    const int rotations = context_.options.tilt_sigma ? 1 : 3;
    Eigen::MatrixXd g(3 + rotations, static_cast<Eigen::Index>(3 * model_.positions.size()));
    for (std::size_t i = 0; i < model_.positions.size(); ++i) {
      const auto c = static_cast<Eigen::Index>(3 * i);
      g.block<3, 3>(0, c).setIdentity();
      g.block(3, c, rotations, 3) = geodesy::skew(model_.positions[i] - mean).bottomRows(rotations);
    }
    for (Eigen::Index r = 0; r < g.rows(); ++r) g.row(r).normalize();
    return g;
  }

  void evaluate(ceres::Problem& problem, std::vector<double>& theta, std::size_t rows) {
    ceres::Problem::EvaluateOptions options;
    for (auto& p : model_.positions) options.parameter_blocks.push_back(p.data());
    for (std::size_t i = 0; i < model_.stations.size(); ++i) options.parameter_blocks.push_back(&theta[3 * i]);
    std::vector<double> residuals;
    ceres::CRSMatrix crs;
    problem.Evaluate(options, nullptr, &residuals, nullptr, &crs);
    Sparse j = Eigen::Map<const Sparse>(crs.num_rows, crs.num_cols, static_cast<Eigen::Index>(crs.values.size()),
                                        crs.rows.data(), crs.cols.data(), crs.values.data());
    o_.jacobian = j.topRows(static_cast<Eigen::Index>(rows));
    o_.residuals = Eigen::Map<Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(rows));
    o_.squares = o_.residuals.squaredNorm();
    Eigen::SparseMatrix<double> normal = (o_.jacobian.transpose() * o_.jacobian).eval();
    int defect = 0;
    if (is_free()) {
      const Eigen::MatrixXd g = datum_rows();
      defect = static_cast<int>(g.rows());
      Eigen::MatrixXd dense(g.rows(), normal.cols());
      dense << g, Eigen::MatrixXd::Zero(g.rows(), normal.cols() - g.cols());
      normal += 1e8 * (dense.transpose() * dense).sparseView();
    }
    o_.normal.compute(normal);
    o_.redundancy = static_cast<int>(rows) - static_cast<int>(normal.cols()) + defect;
  }

  NetworkModel& model_;
  const NetworkContext& context_;
  NetworkOutcome& o_;
};

}  // namespace

Eigen::Vector3d sighting_sigma(const Target& t, const Instrument& instrument) {
  const double c = instrument.target_sigma;
  return {std::hypot(t.distance * std::sin(t.zenith) * t.direction_sigma, c),
          std::hypot(t.distance * t.zenith_sigma, c), std::hypot(t.distance_sigma, c)};
}

std::optional<std::size_t> station_named(const NetworkModel& model, const std::string& name) {
  for (std::size_t i = 0; i < model.stations.size(); ++i) {
    if (model.stations[i].readings->name == name) return i;
  }
  return {};
}

void solve_network(NetworkModel& model, const NetworkContext& context, bool robust, NetworkOutcome& outcome) {
  NetworkSolver(model, context, outcome).solve(robust);
}

}  // namespace versine::stationing
