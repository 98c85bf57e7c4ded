// SPDX-License-Identifier: Apache-2.0
#include "versine/report/texts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace versine::report {
namespace {

using ::testing::HasSubstr;

std::ptrdiff_t braces(const std::string& text) {
  return std::count(text.begin(), text.end(), '{');
}

TEST(Texts, EveryLanguageHasEveryKeyWithTheSamePlaces) {
  const Texts english;
  for (const std::string& language : languages()) {
    const auto texts = Texts::load(language);
    ASSERT_TRUE(texts) << texts.error().message();
    EXPECT_EQ(texts->language(), language);
    ASSERT_EQ(texts->all().size(), english.all().size());
    for (const auto& [key, text] : texts->all()) {
      EXPECT_FALSE(text.empty()) << language << " " << key;
      EXPECT_EQ(braces(text), braces(english(key))) << language << " " << key;
    }
  }
}

TEST(Texts, ColumnsHaveNames) {
  const auto german = Texts::load("de");
  ASSERT_TRUE(german);
  EXPECT_EQ(Texts().quantity("alignment_left_d1"), "Alignment left D1");
  EXPECT_EQ(Texts().quantity("twist_3m"), "Twist 3m");
  EXPECT_EQ(Texts().quantity("check_30m_lateral_left_worst"), "30 m check lateral left worst");
  EXPECT_EQ(german->quantity("gauge_deviation"), "Spurweite minus Soll");
  EXPECT_EQ(german->phrase("positive upwards"), "positiv nach oben");
  EXPECT_EQ(german->phrase("what no one translated"), "what no one translated");
  EXPECT_EQ(Texts().quantity("something_else"), "something_else");
  // Sentences with values.
  EXPECT_EQ(
      german->phrase("odometer rejected 11 times in a row until 14.5 s: the filter's covariance was enlarged instead"),
      "Wegmesser: 11-mal hintereinander verworfen bis 14.5 s; statt dessen wurde die Kovarianz des Filters vergrößert");
  EXPECT_EQ(german->phrase("3.25 m of track off the design: no deviations"),
            "3.25 m Gleis außerhalb des Entwurfs: keine Abweichungen");
  EXPECT_EQ(german->phrase("3.25 m of track off the moon: no deviations"),
            "3.25 m of track off the moon: no deviations");
}

TEST(Texts, ATranslationIsAFile) {
  const auto path = std::filesystem::temp_directory_path() / "versine_texts_test.toml";
  std::ifstream english(VERSINE_SOURCE_DIR "/data/texts/en.toml");
  std::string content((std::istreambuf_iterator<char>(english)), {});
  const auto at = content.find("tag = \"en\"");
  ASSERT_NE(at, std::string::npos);
  content.replace(at, 10, "tag = \"fr\"");
  std::ofstream(path) << content;
  const auto texts = Texts::load(path.string());
  ASSERT_TRUE(texts) << texts.error().message();
  EXPECT_EQ(texts->language(), "fr");
  std::ofstream(path) << content.substr(0, content.find("[verdict]"));
  const auto half = Texts::load(path.string());
  ASSERT_FALSE(half);
  EXPECT_THAT(half.error().message(), HasSubstr("no such text"));
  auto wrong = content;
  wrong.replace(wrong.find("page {} of {}"), 13, "page {} of {:d");
  std::ofstream(path) << wrong;
  const auto places = Texts::load(path.string());
  ASSERT_FALSE(places);
  EXPECT_THAT(places.error().message(), HasSubstr("page.number"));
  std::filesystem::remove(path);
  const auto unknown = Texts::load("xx");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message(), HasSubstr("en, de, zh"));
}

}  // namespace
}  // namespace versine::report
