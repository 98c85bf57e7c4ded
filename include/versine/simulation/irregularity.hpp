// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "versine/core/error.hpp"

/// How the real track differs from its design: deviations of both rails along the axis.
namespace versine::simulation {

/// The four ways in which a track deviates, as spectra treat them: independent of each other.
enum class Irregularity { level, alignment, cross_level, gauge };

/// A published power spectral density of track irregularities.
/// - german_low, german_high: ERRI B176 (1993), low and high disturbance;
/// - fra_4 to fra_6: Federal Railroad Administration track classes (Hamid et al. 1983);
/// - china_ballastless: mean spectrum of ballastless high-speed track, TB/T 3352-2014 (Kang et al. 2014).
enum class Spectrum { none, german_low, german_high, fra_4, fra_5, fra_6, china_ballastless };
[[nodiscard]] std::span<const std::pair<std::string_view, Spectrum>> spectrum_names();

/// One-sided density over spatial frequency, m^2/(1/m), at `frequency`, 1/m. Level and alignment are of the axis (mean
/// of both rails), cross level is the height difference of both rails over 1.5 m, gauge its deviation.
[[nodiscard]] double spectral_density(Spectrum spectrum, Irregularity kind, double frequency);

/// Deviations on a uniform grid of distances, m. Level positive upwards, alignment positive to the right, gauge
/// positive when wider, cross level positive when the left rail is higher.
struct Deviations {
  double begin = 0.0;  ///< distance of the first value, m
  double step = 0.1;   ///< m
  std::vector<double> level, alignment, cross_level, gauge;
};

/// A stationary Gaussian sample of that spectrum between two wavelengths, m, as long as asked for; by inverse Fourier
/// transform with random amplitudes and phases, without the transform's periodicity. Cost n log n.
[[nodiscard]] std::vector<double> synthesize(Spectrum spectrum, Irregularity kind, double step, std::size_t count,
                                             double shortest, double longest, std::uint64_t seed);

/// A single defect on top of the spectrum, a smooth bump of given length centred at a distance.
struct Defect {
  enum class Kind {
    dip,    ///< level of the named rail, downwards for positive amplitude
    bump,   ///< alignment of the named rail, to the right for positive amplitude
    kink,   ///< alignment of both rails: a kink of the axis, amplitude at its vertex, straight legs over `length`
    twist,  ///< cross level goes to `amplitude` and back within `length`
    gauge,  ///< gauge widening
    wave,   ///< level of the named rail: sine of wavelength `length` over `extent`
  };
  enum class Rail { left, right, both };
  Kind kind = Kind::dip;
  Rail rail = Rail::both;
  double distance = 0.0;   ///< of its centre along the axis, m
  double amplitude = 0.0;  ///< m
  double length = 5.0;     ///< m: of the bump, of a leg pair, or the wavelength
  double extent = 0.0;     ///< of a wave, m
};

/// Deviation that a defect adds at a distance.
struct Deviation {
  double level = 0.0, alignment = 0.0, cross_level = 0.0, gauge = 0.0;
};
[[nodiscard]] Deviation deviation_of(const Defect& defect, double distance);

}  // namespace versine::simulation
