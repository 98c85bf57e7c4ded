// SPDX-License-Identifier: Apache-2.0
#include "versine/geodesy/similarity.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "versine/geodesy/height_datum.hpp"

namespace versine::geodesy {
namespace {

/// Points over a kilometre with map-sized coordinates, moved, turned and scaled, with noise.
std::vector<CommonPoint> points(int count, bool space, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-500.0, 500.0);
  std::normal_distribution<double> normal(0.0, noise);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(space ? 0.002 : 0.0, Eigen::Vector3d(1.0, 2.0, 0.0).normalized()))
                                   .toRotationMatrix();
  std::vector<CommonPoint> out;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d d(place(random), place(random), 0.05 * place(random));
    Eigen::Vector3d moved = turn * d;
    moved.head(space ? 3 : 2) *= 1.00002;  // in the plane heights keep their own scale
    out.push_back({"P" + std::to_string(i), Eigen::Vector3d(1000.0, 2000.0, 100.0) + d,
                   Eigen::Vector3d(3456789.0, 5678901.0, 150.0) + moved +
                       Eigen::Vector3d(normal(random), normal(random), normal(random)),
                   1e-3});
  }
  return out;
}

TEST(Similarity, RecoversAnExactTransformationInPlaneAndSpace) {
  for (const bool space : {false, true}) {
    const auto p = points(5, space, 0.0, 3);
    const auto s = fit_similarity(p, {.three_dimensional = space});
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->scale, 1.00002, 1e-10);
    EXPECT_NEAR(s->rotation_z(), 0.7, 1e-5);
    for (const CommonPoint& c : p) {
      EXPECT_LT((s->apply(c.source) - c.target).norm(), 5e-9);
      EXPECT_LT((s->inverse(s->apply(c.source)) - c.source).norm(), 5e-9);
    }
  }
}

TEST(Similarity, TwoPointsAreEnoughInThePlaneAndFewerAreRefused) {
  const auto p = points(5, false, 1e-3, 4);
  const auto two = fit_similarity({p[0], p[1]});
  ASSERT_TRUE(two);
  EXPECT_EQ(two->redundancy, 0);
  EXPECT_TRUE(std::isnan(two->sigma0));
  EXPECT_LT((two->apply(p[0].source) - p[0].target).head<2>().norm(), 1e-9);
  const auto one = fit_similarity({p[0]});
  ASSERT_FALSE(one);
  EXPECT_NE(one.error().message().find("at least 2"), std::string::npos);
  EXPECT_FALSE(fit_similarity({p[0], p[0]}));
  EXPECT_FALSE(fit_similarity({p[0], p[1]}, {.three_dimensional = true}));
  auto line = p;
  for (std::size_t i = 0; i < line.size(); ++i)
    line[i].source = Eigen::Vector3d(10.0 * static_cast<double>(i), 0.0, 0.0);
  EXPECT_FALSE(fit_similarity(line, {.three_dimensional = true}));
}

TEST(Similarity, AnOutlyingPointIsFoundAndLeftOut) {
  for (const bool space : {false, true}) {
    auto p = points(7, space, 1e-3, 11);
    p[4].target.x() += 0.02;
    const auto s = fit_similarity(p, {.three_dimensional = space});
    ASSERT_TRUE(s);
    for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(s->residuals[i].outlying, i == 4) << i;
    EXPECT_NEAR(s->residuals[4].residual.x(), 0.02, 5e-3);
    EXPECT_LT(s->sigma0, 2.5);
  }
}

TEST(Similarity, SigmasAgreeWithTheScatterOfManyTrials) {
  for (const bool space : {false, true}) {
    double scale = 0.0, sigma0 = 0.0, sigma_scale = 0.0;
    constexpr int trials = 400;
    for (int t = 0; t < trials; ++t) {
      auto p = points(6, space, 0.0, 20);
      std::mt19937 random(static_cast<unsigned>(t));
      std::normal_distribution<double> normal(0.0, 1e-3);
      for (CommonPoint& c : p) c.target += Eigen::Vector3d(normal(random), normal(random), normal(random));
      const auto s = fit_similarity(p, {.three_dimensional = space, .significance = 1e-9});
      ASSERT_TRUE(s);
      scale += std::pow(s->scale - 1.00002, 2);
      sigma0 += s->sigma0 * s->sigma0;
      sigma_scale = s->parameter_sigma[space ? 6 : 3];
    }
    EXPECT_NEAR(std::sqrt(scale / trials) / sigma_scale, 1.0, 0.12);
    EXPECT_NEAR(sigma0 / trials, 1.0, 0.1);
  }
}

TEST(HeightDatum, OffsetAndPlaneFollowTheirPoints) {
  std::vector<HeightPoint> p;
  for (int i = 0; i < 6; ++i) {
    const double e = 3e6 + 300.0 * i, n = 5e6 + 200.0 * (i % 3);
    p.push_back({"H" + std::to_string(i), e, n, 400.0 + i, 353.5 + i + 20e-6 * (e - 3e6) - 10e-6 * (n - 5e6), 2e-3});
  }
  const auto plane = HeightDatum::plane(p);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->slope_east(), 20e-6, 1e-11);
  EXPECT_NEAR(plane->slope_north(), -10e-6, 1e-11);
  for (const HeightPoint& h : p) EXPECT_NEAR(plane->apply({}, {h.easting, h.northing, h.measured}), h.wanted, 1e-8);
  const auto offset = HeightDatum::offset({p[0]});
  ASSERT_TRUE(offset);
  EXPECT_NEAR(offset->apply({}, {0.0, 0.0, 10.0}), 10.0 + p[0].wanted - p[0].measured, 1e-9);
  EXPECT_FALSE(HeightDatum::offset({}));
  EXPECT_FALSE(HeightDatum::plane({p[0], p[1]}));
  EXPECT_FALSE(HeightDatum::plane({p[0], p[3], p[0]}));  // in one line
  auto wrong = p;
  wrong[2].wanted += 0.05;
  const auto found = HeightDatum::plane(wrong);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->outlying().empty());
}

TEST(HeightDatum, GeoidGridOfProjGivesItsUndulation) {
  const auto geoid = HeightDatum::geoid("egm96_15.gtx");
  if (!geoid) GTEST_SKIP() << "egm96_15.gtx (package proj-data) is not installed";
  // EGM96 at latitude 0, longitude 0: 17.16 m (NGA's own table).
  EXPECT_NEAR(geoid->apply({0.0, 0.0, 100.0}, {}), 100.0 - 17.16, 0.01);
  EXPECT_FALSE(HeightDatum::geoid("no_such_grid.gtx"));
}

}  // namespace
}  // namespace versine::geodesy
