// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/irregularity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "versine/simulation/power_density.hpp"

namespace versine::simulation {
namespace {

TEST(Synthesize, DensityMatchesTheRequestedSpectrum) {
  const double step = 0.25;
  const std::size_t n = 2048;  // 512 m
  for (const auto& [name, spectrum] : spectrum_names()) {
    if (spectrum == Spectrum::none) continue;
    for (const auto kind :
         {Irregularity::level, Irregularity::alignment, Irregularity::cross_level, Irregularity::gauge}) {
      const auto x = synthesize(spectrum, kind, step, 400000, 2.0, 150.0, 5);
      const auto density = power_density(x, step, n);
      const double df = 1.0 / (static_cast<double>(n) * step);
      double rms_found = 0.0, rms_wanted = 0.0;
      for (std::size_t k = 1; k < density.size(); ++k) {
        const double f = static_cast<double>(k) * df;
        if (f < 1.0 / 70.0 || f > 1.0 / 3.0) continue;
        rms_found += density[k] * df, rms_wanted += spectral_density(spectrum, kind, f) * df;
      }
      static constexpr const char* kinds[] = {"level", "alignment", "cross_level", "gauge"};
      RecordProperty(std::string(name) + "_" + kinds[static_cast<int>(kind)],
                     std::to_string(1e3 * std::sqrt(rms_found)) + " of " + std::to_string(1e3 * std::sqrt(rms_wanted)));
      // Octave bands within the wavelengths 2.5 m to 100 m.
      for (double low = 0.01; low < 0.4; low *= 2.0) {
        double found = 0.0, wanted = 0.0;
        for (std::size_t k = 1; k < density.size(); ++k) {
          const double f = static_cast<double>(k) * df;
          if (f < low || f >= std::min(0.4, 2.0 * low)) continue;
          found += density[k] * df, wanted += spectral_density(spectrum, kind, f) * df;
        }
        EXPECT_NEAR(found / wanted, 1.0, 0.15) << name << " " << static_cast<int>(kind) << " from " << low;
      }
    }
  }
}

TEST(Synthesize, GermanLowHasItsVariance) {
  // Variance over the band is the integral of the density.
  const auto x = synthesize(Spectrum::german_low, Irregularity::level, 0.2, 500000, 3.0, 25.0, 11);
  double variance = 0.0, wanted = 0.0;
  for (const double v : x) variance += v * v / static_cast<double>(x.size());
  for (double f = 0.04; f < 1.0 / 3.0; f += 1e-4) {
    wanted += 1e-4 * spectral_density(Spectrum::german_low, Irregularity::level, f + 5e-5);
  }
  EXPECT_NEAR(variance / wanted, 1.0, 0.03);
}

TEST(Spectra, PiecesOfTheChineseSpectrumJoin) {
  for (const auto kind :
       {Irregularity::level, Irregularity::alignment, Irregularity::cross_level, Irregularity::gauge}) {
    double before = spectral_density(Spectrum::china_ballastless, kind, 0.005);
    for (double f = 0.005 * 1.001; f < 1.0; f *= 1.001) {
      const double here = spectral_density(Spectrum::china_ballastless, kind, f);
      EXPECT_NEAR(here / before, 1.0, 0.02) << f;
      before = here;
    }
  }
}

TEST(Defects, HaveTheirAmplitudeAndPlace) {
  const Defect dip{Defect::Kind::dip, Defect::Rail::left, 100.0, 0.008, 6.0, 0.0};
  EXPECT_NEAR(deviation_of(dip, 100.0).level, -0.004, 1e-15);        // half on the axis ...
  EXPECT_NEAR(deviation_of(dip, 100.0).cross_level, -0.008, 1e-15);  // ... all of it between the rails
  EXPECT_EQ(deviation_of(dip, 103.1).level, 0.0);
  EXPECT_NEAR(deviation_of({Defect::Kind::kink, Defect::Rail::both, 10.0, 0.02, 40.0, 0.0}, 10.0).alignment, 0.02,
              1e-15);
  EXPECT_NEAR(deviation_of({Defect::Kind::wave, Defect::Rail::both, 10.0, 0.01, 4.0, 20.0}, 11.0).level, 0.01, 1e-15);
  EXPECT_NEAR(deviation_of({Defect::Kind::twist, Defect::Rail::both, 10.0, 0.009, 3.0, 0.0}, 10.0).cross_level, 0.009,
              1e-15);
}

}  // namespace
}  // namespace versine::simulation
