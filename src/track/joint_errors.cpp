// SPDX-License-Identifier: Apache-2.0
#include "versine/track/joint_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace versine::track {

JointErrors::JointErrors(const filter::ErrorChain& chain, std::span<const Time> times) {
  if (chain.empty()) throw std::invalid_argument("JointErrors: empty chain");
  std::vector<Time> t(times.begin(), times.end());
  reversed_ = t.size() > 1 && t.back() < t.front();
  if (reversed_) std::reverse(t.begin(), t.end());
  const Eigen::Index n = chain.covariance(0).rows();
  std::size_t last = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    std::size_t i = chain.index_at(t[k]);
    if (i + 1 < chain.size() && chain.time(i + 1) - t[k] < t[k] - chain.time(i)) ++i;  // the nearer epoch
    if (k > 0) {
      Eigen::MatrixXf product = Eigen::MatrixXf::Identity(n, n);
      for (std::size_t j = last; j < i; ++j) {
        if (chain.gain(j).size() == 0) {
          product.setZero();
          break;
        }
        product = (product * chain.gain(j)).eval();
      }
      gain_.push_back(std::move(product));
    }
    covariance_.push_back(chain.covariance(i));
    last = i;
  }
}

const std::vector<JointErrors::Matrix6>& JointErrors::at_distance(std::size_t nodes) {
  const auto known = distance_.find(nodes);
  if (known != distance_.end()) return known->second;
  std::vector<Matrix6>& out = distance_[nodes];
  const std::size_t n = size();
  if (n == 0) return out;
  out.reserve(n);
  const Eigen::Index dim = covariance_[0].rows();
  std::vector<Eigen::MatrixXf> front;  // front.back(): product from the window's start to the border of the two stacks
  Eigen::MatrixXf back = Eigen::MatrixXf::Identity(dim, dim);
  std::size_t border = 0;
  for (std::size_t i = 0; i + nodes < n; ++i) {
    const std::size_t end = i + nodes;  // window: gains i .. end - 1
    if (nodes > 0 && i >= border) {
      front.assign(1, Eigen::MatrixXf::Identity(dim, dim));
      for (std::size_t k = end; k-- > i;) front.push_back(gain_[k] * front.back());
      border = end;
      back.setIdentity();
    } else if (nodes > 0) {
      front.pop_back();
      back = (back * gain_[end - 1]).eval();
    }
    if (nodes == 0) {
      out.push_back(covariance_[i].topLeftCorner<6, 6>());
    } else {
      const Eigen::Matrix<float, 6, Eigen::Dynamic> rows = front.back().topRows<6>() * back;
      out.push_back((rows * covariance_[end].leftCols<6>()).eval());
    }
  }
  return out;
}

std::vector<double> JointErrors::variance(std::span<const Term> terms, std::span<const ErrorRow> rows) {
  const auto n = static_cast<std::ptrdiff_t>(size());
  std::vector<double> out(size(), 0.0);
  for (const Term& a : terms) {
    for (const Term& b : terms) {
      if (b.node < a.node) continue;  // the pair is counted twice below
      const auto distance = b.node - a.node;
      const double weight = a.weight * b.weight * (&a == &b ? 1.0 : (distance == 0 ? 1.0 : 2.0));
      const std::vector<Matrix6>& pair = at_distance(static_cast<std::size_t>(distance));
      for (std::ptrdiff_t i = 0; i < n; ++i) {
        const std::ptrdiff_t p = i + a.node, q = i + b.node;
        double& v = out[static_cast<std::size_t>(i)];
        if (p < 0 || q >= n) {
          v = std::numeric_limits<double>::quiet_NaN();
          continue;
        }
        const ErrorRow &hp = rows[static_cast<std::size_t>(p)], &hq = rows[static_cast<std::size_t>(q)];
        // In order of time the earlier node comes first; nodes of a reversed run are stored the other way round.
        const auto first = static_cast<std::size_t>(reversed_ ? n - 1 - q : p);
        const ErrorRow &early = reversed_ ? hq : hp, &late = reversed_ ? hp : hq;
        v += weight * double(early.dot(pair[first] * late));
      }
    }
  }
  for (double& v : out) v = std::max(v, 0.0);  // float rounding; NaN stays: max(NaN, 0) returns its first argument
  return out;
}

std::vector<std::vector<double>> JointErrors::filtered_variance(std::span<const float> weights,
                                                                std::span<const std::span<const ErrorRow>> rows,
                                                                std::size_t every) const {
  const std::size_t n = size(), reach = weights.size() / 2, kinds = rows.size();
  std::vector<std::vector<double>> out(kinds, std::vector<double>(n, std::numeric_limits<double>::quiet_NaN()));
  if (n < 2 * reach + 1) return out;
  const auto dim = covariance_[0].rows();
  // carried.col(r): sum over the nodes before of (A_i ... A_{k-1})^T h_i w_i, so that its product with P_k h_k w_k is
  // the covariance of all of them with node k.
  Eigen::MatrixXf carried(dim, static_cast<Eigen::Index>(kinds)), moved = carried;
  for (std::size_t node = reach; node + reach < n; node += every) {
    const std::size_t begin = reversed_ ? n - 1 - node - reach : node - reach;  // in order of time
    carried.setZero();
    std::vector<double> sum(kinds, 0.0);
    for (std::size_t j = 0; j < weights.size(); ++j) {
      const std::size_t k = begin + j, place = reversed_ ? n - 1 - k : k;
      if (j > 0) {
        moved.noalias() = gain_[k - 1].transpose() * carried;
        carried.swap(moved);
      }
      for (std::size_t r = 0; r < kinds; ++r) {
        const ErrorRow h = weights[j] * rows[r][place];
        const Eigen::VectorXf ph = covariance_[k].leftCols<6>() * h;
        auto column = carried.col(static_cast<Eigen::Index>(r));
        sum[r] += 2.0 * double(column.dot(ph)) + double(h.dot(ph.head<6>()));
        column.head<6>() += h;
      }
    }
    for (std::size_t r = 0; r < kinds; ++r) out[r][node] = std::max(sum[r], 0.0);
  }
  return out;
}

}  // namespace versine::track
