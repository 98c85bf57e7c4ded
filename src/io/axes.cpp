// SPDX-License-Identifier: Apache-2.0
#include "axes.hpp"

#include <Eigen/LU>
#include <array>
#include <utility>

namespace versine::io {

namespace {
constexpr const char* example = "three of forward, backward, right, left, up, down, one of each pair, joined by '-'";

std::pair<int, double> direction(std::string_view word) {
  if (word == "forward") return {0, 1.0};
  if (word == "backward") return {0, -1.0};
  if (word == "right") return {1, 1.0};
  if (word == "left") return {1, -1.0};
  if (word == "down") return {2, 1.0};
  if (word == "up") return {2, -1.0};
  return {-1, 0.0};
}
}  // namespace

Expected<Eigen::Matrix3d> axes_from_words(std::string_view words, const std::string& file) {
  const auto wrong = [&](std::string found, std::string advice) {
    return fail(
        {.file = file, .field = "axes", .found = std::move(found), .expected = example, .advice = std::move(advice)});
  };
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  std::string_view rest = words;
  for (int i = 0; i < 3; ++i) {
    const std::size_t n = i < 2 ? rest.find('-') : rest.size();
    if (n == std::string_view::npos) return wrong("'" + std::string(words) + "'", "for example \"forward-right-down\"");
    const auto [axis, sign] = direction(rest.substr(0, n));
    if (axis < 0) return wrong("'" + std::string(rest.substr(0, n)) + "'", "for example \"right-forward-up\"");
    C(axis, i) = sign;
    rest.remove_prefix(std::min(n + 1, rest.size()));
  }
  const double det = C.determinant();
  if (det == 0.0) return wrong("'" + std::string(words) + "', which leaves a direction out", "name one of each pair");
  if (det < 0.0) {
    return wrong(
        "'" + std::string(words) + "', which is left-handed",
        "turn one word into its opposite: x, y, z must be like thumb, first and middle finger of the right hand");
  }
  return C;
}

Expected<Eigen::Matrix3d> axes_from_matrix(const Eigen::Matrix3d& matrix, const std::string& file) {
  const double off = (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (off < 1e-3 && matrix.determinant() > 0.0) return matrix;
  return fail({.file = file,
               .field = "rotation",
               .found = "a matrix that is no rotation",
               .expected = "nine numbers, row by row, orthogonal within 1e-3, determinant +1",
               .advice = "it turns sensor axes into forward-right-down; use axes = \"...\" for plain directions"});
}

}  // namespace versine::io
