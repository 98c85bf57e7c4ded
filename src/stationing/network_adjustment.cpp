// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/network_adjustment.hpp"

#include <ceres/autodiff_cost_function.h>
#include <ceres/crs_matrix.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/rotation.h>
#include <ceres/solver.h>
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

#include "network_model.hpp"
#include "statistics.hpp"
#include "versine/geodesy/attitude.hpp"

namespace versine::stationing {
namespace {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

template <class T>
Vector3<T> to_instrument(const Eigen::Quaterniond& q, const T* theta, const Vector3<T>& d) {
  const T turn[3] = {-theta[0], -theta[1], -theta[2]};
  Vector3<T> turned;
  ceres::AngleAxisRotatePoint(turn, d.data(), turned.data());
  return q.conjugate().toRotationMatrix().template cast<T>() * turned;
}

struct SightingResidual {
  Eigen::Quaterniond q;
  Eigen::Vector3d rise;  ///< prism's height over its point less the instrument's over its mark, m-frame
  Eigen::Vector3d observed;
  Eigen::Vector3d sigma;
  template <class T>
  bool operator()(const T* mark, const T* theta, const T* point, T* residual) const {
    const Eigen::Map<const Vector3<T>> a(mark), b(point);
    const Vector3<T> v = to_instrument<T>(q, theta, b - a + rise.template cast<T>());
    const Vector3<T> r = misclosure<T>(v, T(1.0), observed(0), observed(1), observed(2));
    for (int k = 0; k < 3; ++k) residual[k] = r(k) / sigma(k);
    return true;
  }
};

struct LevelResidual {
  Eigen::Quaterniond q;
  Eigen::Vector3d up;
  double sigma;
  template <class T>
  bool operator()(const T* theta, T* residual) const {
    const Vector3<T> u = to_instrument<T>(q, theta, up.template cast<T>());
    residual[0] = u(0) / sigma;
    residual[1] = u(1) / sigma;
    return true;
  }
};

struct PositionResidual {
  Eigen::Vector3d given;
  Eigen::Matrix3d whitening;
  template <class T>
  bool operator()(const T* point, T* residual) const {
    Eigen::Map<Vector3<T>>(residual, 3) =
        whitening.template cast<T>() * (Eigen::Map<const Vector3<T>>(point) - given.template cast<T>());
    return true;
  }
};

struct DifferenceResidual {
  Eigen::Vector3d given;
  Eigen::Matrix3d whitening;
  template <class T>
  bool operator()(const T* from, const T* to, T* residual) const {
    Eigen::Map<Vector3<T>>(residual, 3) =
        whitening.template cast<T>() *
        (Eigen::Map<const Vector3<T>>(to) - Eigen::Map<const Vector3<T>>(from) - given.template cast<T>());
    return true;
  }
};

Eigen::Matrix3d whitening_of(const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d w = Eigen::Matrix3d::Identity();
  covariance.llt().matrixL().solveInPlace(w);
  return w;
}

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// What one adjustment leaves behind for the tests.
struct Outcome {
  Eigen::VectorXd residuals;  ///< whitened
  Sparse jacobian;            ///< whitened; columns: points, then attitudes
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> normal;
  std::vector<std::size_t> sighting_row, control_row;  ///< first row; npos: not used
  int redundancy = 0;
  double squares = 0.0;
};
constexpr std::size_t npos = static_cast<std::size_t>(-1);

class Network {
 public:
  Network(NetworkModel model, const Instrument& instrument, const NetworkOptions& options,
          std::span<const RelativePosition> relative)
      : model_(std::move(model)),
        instrument_(instrument),
        options_(options),
        relative_(relative),
        critical_(chi_square_quantile(3, options.significance)) {}

  Expected<NetworkResult> run() {
    if (auto ok = check_relative(); !ok) return tl::unexpected(ok.error());
    for (const bool robust : {true, false}) solve(robust);
    for (int round = 0; options_.snoop && round < 200; ++round) {
      if (auto ok = determined(); !ok) return tl::unexpected(ok.error());
      test();
      if (!leave_out_worst()) break;
      solve(false);
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

  std::optional<std::size_t> station_named(const std::string& name) const {
    for (std::size_t i = 0; i < model_.stations.size(); ++i) {
      if (model_.stations[i].readings->name == name) return i;
    }
    return {};
  }

  Expected<void> check_relative() const {
    for (const RelativePosition& r : relative_) {
      for (const std::string& name : {r.from, r.to}) {
        if (!station_named(name)) {
          return fail({.field = "relative positions",
                       .found = fmt::format("station '{}'", name),
                       .expected = "a station of the network",
                       .advice = "remove the difference, or add the station"});
        }
      }
    }
    return {};
  }

  Eigen::Vector3d sigma_of(const Target& t) const {
    const double c = instrument_.target_sigma;
    return {std::hypot(t.distance * std::sin(t.zenith) * t.direction_sigma, c),
            std::hypot(t.distance * t.zenith_sigma, c), std::hypot(t.distance_sigma, c)};
  }

  SightingResidual residual_of(const NetworkSighting& s) const {
    const NetworkStation& station = model_.stations[s.station];
    const Eigen::Vector3d &a = model_.positions[station.mark], &b = model_.positions[s.point];
    return {station.q_ms,
            s.target->target_height * up_at(b) - station.height * up_at(a),
            {s.target->direction, s.target->zenith, s.target->distance},
            sigma_of(*s.target)};
  }

  /// One least-squares solution from the present values; the solution replaces them.
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
    for (const RelativePosition& r : relative_) {
      const NetworkStation &a = model_.stations[*station_named(r.from)], &b = model_.stations[*station_named(r.to)];
      const Eigen::Vector3d between_marks =
          r.difference - b.height * up_at(model_.positions[b.mark]) + a.height * up_at(model_.positions[a.mark]);
      row += 3;
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<DifferenceResidual, 3, 3, 3>(
                                   new DifferenceResidual{between_marks, whitening_of(r.covariance)}),
                               nullptr, model_.positions[a.mark].data(), model_.positions[b.mark].data());
    }
    for (std::size_t i = 0; options_.tilt_sigma && i < model_.stations.size(); ++i) {
      row += 2;
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<LevelResidual, 2, 3>(new LevelResidual{
              model_.stations[i].q_ms, up_at(model_.positions[model_.stations[i].mark]), *options_.tilt_sigma}),
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
    const int rotations = options_.tilt_sigma ? 1 : 3;
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
                        .sigma = sigma_of(*s.target),
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
  const Instrument& instrument_;
  const NetworkOptions& options_;
  std::span<const RelativePosition> relative_;
  double critical_;
  Outcome o_;
  std::vector<NetworkResidual> residuals_;
  std::vector<double> control_test_;
};

}  // namespace

Expected<NetworkResult> adjust_network(std::span<const ReducedStation> stations, const ControlNetwork& control,
                                       const Instrument& instrument, const NetworkOptions& options,
                                       std::span<const RelativePosition> relative) {
  auto model = build_network(stations, control, options);
  if (!model) return tl::unexpected(model.error());
  return Network(std::move(*model), instrument, options, relative).run();
}

}  // namespace versine::stationing
