// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace versine::app {

/// One quantity over distance or time, ready to be drawn at every zoom: the samples, and above them levels of buckets
/// of 4, 16, 64, ... samples with their smallest and largest value, and smallest and largest bound of the 95 % band.
/// A bucket is NaN only where all its samples are. Values in the file's units; immutable.
class ViewSeries {
 public:
  using Places = std::shared_ptr<const std::vector<double>>;
  /// `x` increases; `sigma` is empty when the quantity has none. REQUIRES equal sizes.
  ViewSeries(Places x, const std::vector<double>& value, const std::vector<double>& sigma);

  [[nodiscard]] std::size_t size() const { return value_.size(); }
  [[nodiscard]] bool has_sigma() const { return !sigma_.empty(); }
  [[nodiscard]] const std::vector<double>& x() const { return *x_; }

  /// What to draw between two places, one more on each side included: the samples where at most `buckets` lie there (or
  /// `buckets` is 0), else the finest level with at most that many, the coarsest (100 to 400) if none has.
  /// Little-endian: uint32 n, uint32 kind, float64 x[n], then float32 arrays of n: kind 0: min, max; 1: min, max,
  /// lower, upper; 2: value; 3: value, sigma.
  [[nodiscard]] std::string encode(double from, double to, std::size_t buckets) const;

  struct Sample {
    double x;
    float value, sigma;  ///< NaN where there is none
  };
  /// The sample nearest to a place; nothing of an empty series.
  [[nodiscard]] std::optional<Sample> at(double x) const;

 private:
  struct Level {
    std::vector<double> x;
    std::vector<float> min, max, lower, upper;
  };
  static Level coarser(const Level& fine);
  Places x_;
  std::vector<float> value_, sigma_;
  std::vector<Level> levels_;
};

}  // namespace versine::app
