// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

/// Zero-phase Butterworth filters over mileage. Debian's signal libraries design and run in single precision, which is
/// not enough for a 150 m wavelength at a 0.25 m step; hence second-order sections in double here.
namespace versine::track {

/// One second-order section, a0 = 1: y = b0 x + b1 x1 + b2 x2 - a1 y1 - a2 y2.
struct Biquad {
  double b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0;
};

/// Band-pass for wavelengths from `shortest` to `longest` (m) of samples every `step` (m). `order` is that of the
/// low-pass prototype: 4 makes eight poles, 24 dB per octave on each side in one pass. The sections are meant for
/// `filter_both_ways`, which squares the gain; the edges are placed so that the gain of both passes together is -3 dB
/// at `shortest` and `longest`: gain(w) = 1 / (1 + (sqrt(2) - 1) W^(2 order)), W the band-pass transform of w.
/// REQUIRES longest > shortest > 2 step, order >= 1.
[[nodiscard]] std::vector<Biquad> band_pass(double shortest, double longest, double step, int order);
/// Low-pass for wavelengths above `shortest`, -3 dB there in both passes together. REQUIRES shortest > 2 step.
[[nodiscard]] std::vector<Biquad> low_pass(double shortest, double step, int order);

/// Gain of both passes together at a wavelength: what a sine of amplitude 1 leaves the filter with.
[[nodiscard]] double gain_both_ways(std::span<const Biquad> sections, double wavelength, double step);

/// Filters forward, then backward: no phase shift. The ends are continued by point reflection over `settle` samples
/// (as far as there are), so that a trend starts no transient. A run of NaN ends a piece; each piece is filtered
/// on its own and NaN stays NaN.
[[nodiscard]] std::vector<double> filter_both_ways(std::span<const Biquad> sections, std::span<const double> x,
                                                   std::size_t settle);

}  // namespace versine::track
