// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/power_density.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace versine::simulation {

std::vector<double> power_density(std::span<const double> series, double step, std::size_t piece) {
  if (series.size() < piece) return {};
  std::vector<double> window(piece), density(piece / 2 + 1, 0.0), windowed(piece);
  double power = 0.0;
  for (std::size_t i = 0; i < piece; ++i) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(piece);
    window[i] = 0.5 - 0.5 * std::cos(phase);
    power += window[i] * window[i];
  }
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> spectrum;
  std::size_t pieces = 0;
  for (std::size_t at = 0; at + piece <= series.size(); at += piece / 2, ++pieces) {
    for (std::size_t i = 0; i < piece; ++i) windowed[i] = window[i] * series[at + i];
    fft.fwd(spectrum, windowed);
    for (std::size_t k = 0; k < density.size(); ++k) density[k] += 2.0 * step * std::norm(spectrum[k]) / power;
  }
  for (double& d : density) d /= static_cast<double>(pieces);
  return density;
}

}  // namespace versine::simulation
