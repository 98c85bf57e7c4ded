// SPDX-License-Identifier: Apache-2.0
#include "versine/io/landxml.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "support/shared_data.hpp"
#include "versine/core/numbers.hpp"
#include "versine/io/alignment_file.hpp"
#include "versine/io/tra_gra.hpp"

namespace versine::io {
namespace {

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("versine_landxml_" + std::to_string(::getpid()) + "_" + name);
}

design::Alignment sample() {
  using namespace design;
  Alignment a;
  a.name = "sample";
  a.crs = "EPSG:25832";
  std::vector<HorizontalElement> elements;
  for (const Shape shape : {Shape::clothoid, Shape::helmert, Shape::bloss, Shape::cosine, Shape::sine, Shape::viennese,
                            Shape::cubic_parabola}) {
    const double r = shape == Shape::bloss || shape == Shape::sine ? -700.0 : 900.0;
    elements.push_back(line(120.0));
    elements.push_back(transition(shape, 100.0, inf, r));
    elements.push_back(arc(150.0, r));
    elements.push_back(transition(shape, 100.0, r, inf));
  }
  std::vector<CantPoint> cant;
  double s = 0.0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (is_transition(elements[i].shape)) {
      const double k1 = elements[i].curvature_start, k2 = elements[i].curvature_end;
      cant.push_back({s, k1 * 90.0, elements[i].shape});
      cant.push_back({s + elements[i].length, k2 * 90.0, Shape::clothoid});
      if (elements[i].shape == Shape::viennese) elements[i].cant_term = 1.8 * 90.0 * (k2 - k1) / cant_base;
    }
    s += elements[i].length;
  }
  a.horizontal = *HorizontalAxis::chain({3456789.0, 5678901.0, 1.0}, elements);
  a.cant = *CantProfile::from_points(cant);
  a.profile = *Profile::from_points({{0.0, 100.0},
                                     {500.0, 106.0, VerticalPoint::Curve::parabola, 80.0},
                                     {1500.0, 98.0, VerticalPoint::Curve::circle, 0.0, 8000.0},
                                     {3290.0, 115.0}});
  a.chainage = *Chainage::from_equations({{0.0, 12000.0}, {1000.0, 12990.0}, {2000.0, 14010.0}});
  return a;
}

TEST(LandXml, SigmasOfAMeasuredAxisAreInItAndDisturbNoReader) {
  design::OptimalAxis axis;
  axis.alignment = sample();
  const auto count = axis.alignment.horizontal.elements().size();
  axis.sigma.assign(count, {.joint = 0.013, .length = 0.027, .curvature = 1e-8, .cant = 1e-4});
  axis.gradient_sigma = {{1e-6, 0.0, 0.0}, {2e-6, 0.31, 1.5}, {3e-6, 0.42, 2.5}};
  const auto with = temporary("sigma.xml"), without = temporary("plain.xml");
  ASSERT_TRUE(write_landxml(with, axis));
  ASSERT_TRUE(write_landxml(without, std::vector{axis.alignment}));
  std::ifstream file(with);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto a = read_landxml(with), b = read_landxml(without);
  std::filesystem::remove(with);
  std::filesystem::remove(without);
  ASSERT_TRUE(a && b);
  ASSERT_TRUE(a->front().alignment);
  EXPECT_EQ(a->front().audit.size(), b->front().audit.size());
  EXPECT_DOUBLE_EQ(a->front().alignment->length(), b->front().alignment->length());
  const auto found = [&](const std::string& label, const std::string& value) {
    const std::string property = "<Property label=\"" + label + "\" value=\"" + value + "\" />";
    std::size_t n = 0;
    for (auto at = text.find(property); at != std::string::npos; at = text.find(property, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(found("start_m", "0.013"), count);
  EXPECT_EQ(found("length_m", "0.027"), count);
  EXPECT_EQ(found("radius_m", "0.0081"), 5u);  // 1e-8 times 900 m squared
  EXPECT_EQ(found("radius_m", "0.0049"), 2u);
  EXPECT_EQ(found("cant_m", "0.0001"), 14u);  // lines and arcs
  EXPECT_EQ(found("gradient_2", "2e-06"), 1u);
  EXPECT_EQ(found("station_3_m", "0.42"), 1u);
  EXPECT_EQ(found("station_1_m", "0"), 0u);  // the start of the profile is not estimated
}

TEST(LandXml, RoundTripKeepsEveryValueWithinAMicrometre) {
  const design::Alignment a = sample();
  const auto path = temporary("round.xml");
  ASSERT_TRUE(write_landxml(path, std::vector{a}));
  const auto read = read_alignment({path}, "sample");
  std::filesystem::remove(path);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->crs, a.crs);
  ASSERT_NEAR(read->length(), a.length(), 1e-6);
  for (double s = 0.0; s <= a.length(); s += 7.3) {
    const design::DesignPoint p = a.at(s), q = read->at(s);
    ASSERT_NEAR(p.easting, q.easting, 1e-6) << s;
    ASSERT_NEAR(p.northing, q.northing, 1e-6) << s;
    ASSERT_NEAR(p.height, q.height, 1e-6) << s;
    ASSERT_NEAR(p.cant, q.cant, 1e-8) << s;
    ASSERT_NEAR(p.curvature, q.curvature, 1e-9) << s;
    ASSERT_NEAR(p.gradient, q.gradient, 1e-8) << s;
    ASSERT_NEAR(a.mileage(s), read->mileage(s), 1e-6);
  }
}

TEST(LandXml, RealFilesOfThreeProgramsAreRead) {
  VERSINE_NEEDS(folder, "alignments/landxml");
  struct Case {
    const char* file;
    std::size_t alignments;
    double length;
  };
  for (const Case& c :
       {Case{"sbb_BC001_provi.xml", 11, 13946.345}, Case{"sbb_BC003_alignments.xml", 4, 40.179354},
        Case{"testfile_simple.xml", 1, 664.832685}, Case{"testfile_clothoid_and_parabola.xml", 1, 18901.844}}) {
    const auto all = read_landxml(folder / c.file);
    ASSERT_TRUE(all) << all.error().message();
    ASSERT_EQ(all->size(), c.alignments);
    for (const design::Imported& imported : *all) {
      EXPECT_TRUE(imported.alignment) << imported.alignment.error().message();
    }
    ASSERT_TRUE(all->front().alignment);
    EXPECT_NEAR(all->front().alignment->length(), c.length, 0.01) << c.file;
  }
}

TEST(LandXml, CantOfRightCurvesIsPositiveInMetresWhateverTheFilesUnit) {
  VERSINE_NEEDS(folder, "alignments/landxml");
  const auto provi = read_alignment({folder / "sbb_BC001_provi.xml"}, "A50034A");  // millimetres
  ASSERT_TRUE(provi);
  EXPECT_NEAR(provi->at(10.0).cant, 0.079, 1e-9);
  EXPECT_GT(provi->at(10.0).curvature, 0.0);
  EXPECT_NEAR(provi->at(740.0).cant, -0.100, 1e-9);
  EXPECT_LT(provi->at(740.0).curvature, 0.0);
  const auto inframodel = read_alignment({folder / "testfile_clothoid_and_parabola.xml"});  // metres
  ASSERT_TRUE(inframodel);
  EXPECT_NEAR(inframodel->at(1000.0).cant, 0.150, 1e-9);
  EXPECT_NEAR(inframodel->at(1000.0).curvature, 1.0 / 802.0, 1e-9);
  EXPECT_NEAR(inframodel->at(15400.0).cant, -0.150 * design::ramp(design::Shape::helmert, 61.518 / 240.0), 1e-4);
}

TEST(LandXml, KilometrePostsOfInframodelBecomeMileage) {
  VERSINE_NEEDS(folder, "alignments/landxml");
  const auto a = read_alignment({folder / "testfile_simple.xml"});
  ASSERT_TRUE(a);
  // The post of km 0 lies 698.486 m before the start, that of km 1 at 304.955 m: kilometre 0 is 1003.44 m long.
  EXPECT_NEAR(a->mileage(0.0), 698.486, 1e-6);
  EXPECT_NEAR(a->mileage(304.954785), 1000.0, 1e-6);
  EXPECT_NEAR(a->mileage(404.954785), 1100.0, 1e-6);
}

TEST(LandXml, BrokenEmptyAndMissingFilesAreNamed) {
  VERSINE_NEEDS(folder, "alignments/landxml");
  for (const char* name : {"testfile_broken.xml", "testfile_empty_xml.xml", "no_such_file.xml"}) {
    const auto all = read_landxml(folder / name);
    ASSERT_FALSE(all) << name;
    EXPECT_NE(all.error().message().find(name), std::string::npos);
    EXPECT_FALSE(all.error().expected.empty());
  }
  const auto path = temporary("cut.xml");
  std::ofstream(path) << "<LandXML><Alignments>\n<Alignment>\n<CoordGeom";
  const auto cut = read_landxml(path);
  std::filesystem::remove(path);
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().line, 3u);
}

TEST(LandXml, AGapIsHealedWhenSmallAndRefusedByNameWhenLarge) {
  const auto with_gap = [](double gap) {
    const auto path = temporary("gap.xml");
    std::ofstream(path) << fmt::format(R"(<LandXML><Alignments><Alignment name="a"><CoordGeom>
<Line name="first"><Start>0 0</Start><End>100 0</End></Line>
<Line name="second"><Start>{} 0</Start><End>200 0</End></Line>
</CoordGeom></Alignment></Alignments></LandXML>)",
                                       100.0 + gap);
    const auto all = read_landxml(path);
    std::filesystem::remove(path);
    return all->front();
  };
  const design::Imported small = with_gap(0.009);
  ASSERT_TRUE(small.alignment);
  ASSERT_FALSE(small.audit.empty());
  EXPECT_EQ(small.audit.front().kind, "gap");
  EXPECT_EQ(small.audit.front().verdict, design::AuditFinding::Verdict::healed);
  const auto joint = [&](double s) { return small.alignment->at(s).northing; };
  EXPECT_NEAR(joint(100.0 + 1e-9), joint(100.0 - 1e-9), 1e-8);
  const design::Imported large = with_gap(0.5);
  ASSERT_FALSE(large.alignment);
  EXPECT_NE(large.alignment.error().message().find("second"), std::string::npos);
  EXPECT_NE(large.alignment.error().message().find("gap"), std::string::npos);
}

TEST(TraGra, RealLineClosesAndItsGradientsAreCarriedToTheTrack) {
  VERSINE_NEEDS(folder, "alignments/db-tra");
  for (const char* side : {"L", "R"}) {
    const auto track = read_tra_gra(folder / fmt::format("6240046{}.TRA", side),
                                    folder / fmt::format("6240045{}.GRA", side), folder / "6240046S.TRA");
    ASSERT_TRUE(track) << track.error().message();
    ASSERT_TRUE(track->alignment) << track->alignment.error().message();
    for (const auto& f : track->audit) {
      EXPECT_NE(f.kind, "length") << to_string(f);  // elements close better than 0.1 mm
    }
    const auto& a = *track->alignment;
    for (double s = 100.0; s < a.length(); s += 50.0) {
      EXPECT_GT(a.at(s).height, 115.0);
      EXPECT_LT(a.at(s).height, 125.0);
      EXPECT_LT(std::abs(a.at(s).gradient), 0.0125);
    }
  }
}

TEST(TraGra, TangentsOfTheFileAgreeWithRadiiAndGradients) {
  VERSINE_NEEDS(folder, "alignments/db-tra");
  const auto gra = read_gra(folder / "6240045R.GRA");
  ASSERT_TRUE(gra);
  for (std::size_t i = 1; i + 1 < gra->size(); ++i) {
    const auto &a = (*gra)[i - 1], &p = (*gra)[i], &b = (*gra)[i + 1];
    if (p.radius == 0.0 || b.mileage < p.mileage || p.mileage < a.mileage) continue;
    const double turn =
        (b.height - p.height) / (b.mileage - p.mileage) - (p.height - a.height) / (p.mileage - a.mileage);
    EXPECT_NEAR(p.tangent, 0.5 * p.radius * std::abs(turn), 2e-3) << i;
  }
}

TEST(TraGra, ACutFileIsNamed) {
  const auto path = temporary("cut.TRA");
  std::ofstream(path) << std::string(100, 'x');
  const auto raw = read_tra(path);
  std::filesystem::remove(path);
  ASSERT_FALSE(raw);
  EXPECT_NE(raw.error().message().find("100 bytes"), std::string::npos);
}

}  // namespace
}  // namespace versine::io
