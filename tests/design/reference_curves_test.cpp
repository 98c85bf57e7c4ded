// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <regex>
#include <sstream>

#include "support/shared_data.hpp"
#include "versine/design/alignment.hpp"

namespace versine::design {
namespace {

struct Reference {
  HorizontalElement element;
  std::vector<std::array<double, 3>> points;  // distance, x, y (y to the left)
};

double number_after(const std::string& text, const std::string& key) {
  std::smatch m;
  if (!std::regex_search(text, m, std::regex(key + R"(:\s*(-?[0-9.eE+-]+|straight))"))) return 0.0;
  return m[1] == "straight" ? std::numeric_limits<double>::infinity() : std::stod(m[1]);
}

Reference read(const std::filesystem::path& folder) {
  std::ifstream readme(folder / "README.md");
  std::stringstream all;
  all << readme.rdbuf();
  const std::string text = all.str();
  const std::map<std::string, Shape> shapes = {{"Bloss", Shape::bloss},   {"Clothoid", Shape::clothoid},
                                               {"Cosine", Shape::cosine}, {"Helmert", Shape::helmert},
                                               {"Sine", Shape::sine},     {"Viennese", Shape::viennese}};
  Reference r;
  for (const auto& [name, shape] : shapes) {
    if (text.find("(" + name) != std::string::npos) r.element.shape = shape;
  }
  r.element.length = number_after(text, "Total length of segment");
  // The reference counts left as positive.
  r.element.curvature_start = -1.0 / number_after(text, "Startradius");
  r.element.curvature_end = -1.0 / number_after(text, "Endradius");
  const double cant_start = number_after(text, "StartCantLeft") - number_after(text, "StartCantRight");
  const double cant_end = number_after(text, "EndCantLeft") - number_after(text, "EndCantRight");
  if (r.element.shape == Shape::viennese) r.element.cant_term = 1.8 * (cant_end - cant_start) / cant_base;
  std::ifstream list(folder / (folder.filename().string() + "_geometry_pointlist.txt"));
  for (std::array<double, 3> p{}; list >> p[0] >> p[1] >> p[2];) r.points.push_back(p);
  return r;
}

TEST(ReferenceCurves, All48AreReproducedToTenNanometres) {
  VERSINE_NEEDS(root, "alignments/transition-curves");
  std::size_t curves = 0;
  double worst = 0.0;
  for (const auto& type : std::filesystem::directory_iterator(root)) {
    if (!type.is_directory()) continue;
    for (const auto& folder : std::filesystem::directory_iterator(type.path() / "Dataset")) {
      const Reference r = read(folder.path());
      ASSERT_EQ(r.points.size(), 101u) << folder.path();
      double error = 0.0;
      for (const auto& [s, x, y] : r.points) {
        const AxisPose p = pose_on(r.element, {.heading = std::numbers::pi / 2.0}, s);
        error = std::max(error, std::hypot(p.easting - x, p.northing - y));
      }
      EXPECT_LT(error, 2e-8) << folder.path();
      worst = std::max(worst, error);
      ++curves;
    }
  }
  EXPECT_EQ(curves, 48u);
  RecordProperty("worst_m", std::to_string(worst));
  std::printf("48 reference curves: worst difference %.2g m\n", worst);
}

}  // namespace
}  // namespace versine::design
