// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/irregularity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "versine/simulation/random.hpp"

namespace versine::simulation {

namespace {
constexpr double pi = std::numbers::pi;

/// ERRI B176: density over angular spatial frequency w, rad/m, one-sided, m^2/(rad/m).
double german(double A_level, double A_alignment, double A_gauge, Irregularity kind, double w) {
  constexpr double wc = 0.8246, wr = 0.0206, ws = 0.4380;
  const double w2 = w * w;
  const double base = wc * wc / ((w2 + wr * wr) * (w2 + wc * wc));
  switch (kind) {
    case Irregularity::level:
      return A_level * base;
    case Irregularity::alignment:
      return A_alignment * base;
    // B176 gives the angle with b = 0.75 m, half the distance of the contact points; times (2 b)^2 it is a height.
    case Irregularity::cross_level:
      return 4.0 * A_level * base * w2 / (w2 + ws * ws);
    case Irregularity::gauge:
      return A_gauge * base * w2 / (w2 + ws * ws);
  }
  return 0.0;
}

/// FRA: A in cm^2 rad/m, k = 0.25; result m^2/(rad/m).
double fra(double A_level, double A_alignment, double ws, Irregularity kind, double w) {
  constexpr double wc = 0.8245, k = 0.25, cm2 = 1e-4;
  const double w2 = w * w, wc2 = wc * wc;
  switch (kind) {
    case Irregularity::level:
      return cm2 * k * A_level * wc2 / (w2 * (w2 + wc2));
    case Irregularity::alignment:
      return cm2 * k * A_alignment * wc2 / (w2 * (w2 + wc2));
    case Irregularity::cross_level:
    case Irregularity::gauge:
      return cm2 * 4.0 * k * A_level * wc2 / ((w2 + wc2) * (w2 + ws * ws));
  }
  return 0.0;
}

/// TB/T 3352-2014: A / f^n in mm^2/(1/m), in pieces of f, 1/m.
struct Power {
  double up_to, A, n;
};
double china(Irregularity kind, double f) {
  static constexpr std::array gauge{Power{0.1090, 5.4978e-2, 0.8282}, Power{0.2938, 5.0701e-3, 1.9037},
                                    Power{1e9, 1.8778e-4, 4.5948}};
  static constexpr std::array cross{Power{0.0258, 3.6148e-3, 1.7278}, Power{0.1163, 4.3685e-2, 1.0461},
                                    Power{1e9, 4.5867e-3, 2.0939}};
  static constexpr std::array alignment{Power{0.0450, 3.9513e-3, 1.8670}, Power{0.1234, 1.1047e-2, 1.5354},
                                        Power{1e9, 7.5633e-4, 2.8171}};
  static constexpr std::array level{Power{0.0187, 1.0544e-5, 3.3891}, Power{0.0474, 3.5588e-3, 1.9271},
                                    Power{0.1533, 1.9784e-2, 1.3643}, Power{1e9, 3.9488e-4, 3.4516}};
  std::span<const Power> pieces = level;
  if (kind == Irregularity::gauge) pieces = gauge;
  if (kind == Irregularity::cross_level) pieces = cross;
  if (kind == Irregularity::alignment) pieces = alignment;
  const auto piece = std::find_if(pieces.begin(), pieces.end(), [&](const Power& p) { return f < p.up_to; });
  return 1e-6 * piece->A * std::pow(f, -piece->n);
}
}  // namespace

std::span<const std::pair<std::string_view, Spectrum>> spectrum_names() {
  static constexpr std::array<std::pair<std::string_view, Spectrum>, 7> names{{
      {"none", Spectrum::none},
      {"german-low", Spectrum::german_low},
      {"german-high", Spectrum::german_high},
      {"fra-4", Spectrum::fra_4},
      {"fra-5", Spectrum::fra_5},
      {"fra-6", Spectrum::fra_6},
      {"china-ballastless", Spectrum::china_ballastless},
  }};
  return names;
}

double spectral_density(Spectrum spectrum, Irregularity kind, double frequency) {
  const double w = 2.0 * pi * frequency;  // S(f) df = S(w) dw
  switch (spectrum) {
    case Spectrum::none:
      return 0.0;
    case Spectrum::german_low:
      return 2.0 * pi * german(4.032e-7, 2.119e-7, 5.32e-8, kind, w);
    case Spectrum::german_high:
      return 2.0 * pi * german(1.08e-6, 6.125e-7, 1.032e-7, kind, w);
    case Spectrum::fra_4:
      return 2.0 * pi * fra(0.5376, 0.3027, 1.1312, kind, w);
    case Spectrum::fra_5:
      return 2.0 * pi * fra(0.2095, 0.0762, 0.8209, kind, w);
    case Spectrum::fra_6:
      return 2.0 * pi * fra(0.0339, 0.0339, 0.4380, kind, w);
    case Spectrum::china_ballastless:
      return china(kind, frequency);
  }
  return 0.0;
}

std::vector<double> synthesize(Spectrum spectrum, Irregularity kind, double step, std::size_t count, double shortest,
                               double longest, std::uint64_t seed) {
  std::vector<double> out(count, 0.0);
  if (spectrum == Spectrum::none || count == 0) return out;
  // The transform repeats after its length: make it longer by the longest wavelength and cut.
  std::size_t n = 1024;
  while (static_cast<double>(n) < static_cast<double>(count) + 4.0 * longest / step) n *= 2;
  static constexpr std::array<std::string_view, 4> names{"track.level", "track.alignment", "track.cross_level",
                                                         "track.gauge"};
  RandomStream random(seed, names[static_cast<std::size_t>(kind)]);
  std::vector<std::complex<double>> amplitudes(n / 2 + 1);
  const double df = 1.0 / (static_cast<double>(n) * step);
  for (std::size_t k = 1; k < n / 2; ++k) {
    const double f = static_cast<double>(k) * df;
    if (f < 1.0 / longest || f > 1.0 / shortest) continue;
    // x = sum of (a cos + b sin), a and b normal with variance S df: half the complex amplitude on each side.
    const double sigma = 0.5 * static_cast<double>(n) * std::sqrt(spectral_density(spectrum, kind, f) * df);
    amplitudes[k] = {sigma * random.normal(), sigma * random.normal()};
  }
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> all(n);
  fft.inv(all.data(), amplitudes.data(), static_cast<Eigen::Index>(n));
  std::copy_n(all.begin(), count, out.begin());
  return out;
}

namespace {
/// Smooth bump of unit height over [-1/2, 1/2]: cos^4, three times continuously differentiable at its feet.
double bump(double x) {
  if (std::abs(x) >= 0.5) return 0.0;
  const double c = std::cos(pi * x);
  return c * c * c * c;
}
}  // namespace

Deviation deviation_of(const Defect& defect, double distance) {
  const double x = distance - defect.distance;
  const double shape = defect.amplitude * bump(x / defect.length);
  // A change of one rail moves the axis by half of it.
  const double share = defect.rail == Defect::Rail::both ? 1.0 : 0.5;
  const double side = defect.rail == Defect::Rail::left ? 1.0 : defect.rail == Defect::Rail::right ? -1.0 : 0.0;
  switch (defect.kind) {
    case Defect::Kind::dip:
      return {.level = -share * shape, .cross_level = -side * shape};
    case Defect::Kind::bump:
      return {.alignment = share * shape, .gauge = -side * shape};
    case Defect::Kind::twist:
      return {.cross_level = shape};
    case Defect::Kind::gauge:
      return {.gauge = shape};
    case Defect::Kind::kink: {
      // Straight legs meet in a vertex that a rail's stiffness rounds over 1 m.
      const double leg = 0.5 * defect.length;
      if (std::abs(x) >= leg) return {};
      const double rounded = std::sqrt(x * x + 0.25) - 0.5;
      const double end = std::sqrt(leg * leg + 0.25) - 0.5;
      return {.alignment = defect.amplitude * (1.0 - rounded / end)};
    }
    case Defect::Kind::wave: {
      const double window = std::abs(x) <= 0.5 * defect.extent ? 1.0 : 0.0;
      const double wave = window * defect.amplitude * std::sin(2.0 * pi * x / defect.length);
      return {.level = share * wave, .cross_level = side * wave};
    }
  }
  return {};
}

}  // namespace versine::simulation
