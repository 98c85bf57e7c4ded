// SPDX-License-Identifier: Apache-2.0
#include "versine/app/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "versine/core/units.hpp"

namespace versine::app {
namespace {

using ::testing::HasSubstr;

struct Item {
  std::string name;
};
struct Sample {
  double noise = 0.1 * units::deg;
  int rate = 5;
  InputPath file;
  std::vector<Item> items;
};
void describe(ConfigVisitor& v, Sample& s) {
  v.value("noise_deg", s.noise, {.doc = "Noise.", .unit = "deg", .scale = units::deg, .positive = true});
  v.table("output", "What is written.", [&](ConfigVisitor& t) {
    t.value("rate_hz", s.rate, {.doc = "Rate.", .unit = "Hz", .min = 1, .max = 100});
    t.value("file", s.file, {.doc = "Where to."});
  });
  v.tables<Item>("item", "Things.", s.items,
                 [](ConfigVisitor& t, Item& i) { t.value("name", i.name, {.doc = "Name.", .required = true}); });
}
Expected<Sample> parse(std::string_view text, std::vector<std::string> overrides = {}) {
  Sample s;
  auto done = parse_config(text, "folder/job.toml", [&](ConfigVisitor& v) { describe(v, s); }, overrides);
  if (!done) return tl::unexpected(done.error());
  return s;
}

TEST(Config, ReadsValuesInTheUsersUnit) {
  const auto s = parse("noise_deg = 2\n[output]\nrate_hz = 10\nfile = 'a.csv'\n[[item]]\nname='x'\n[[item]]\nname='y'");
  ASSERT_TRUE(s) << s.error().message();
  EXPECT_DOUBLE_EQ(s->noise, 2 * units::deg);
  EXPECT_EQ(s->rate, 10);
  EXPECT_THAT(s->file.path.string(), HasSubstr("folder/a.csv"));
  ASSERT_EQ(s->items.size(), 2u);
  EXPECT_EQ(s->items[1].name, "y");
}

TEST(Config, UnknownKeyNamesTheNearestAndItsLine) {
  const auto s = parse("[output]\nrtae_hz = 10\n");
  ASSERT_FALSE(s);
  EXPECT_EQ(s.error().line, 2u);
  EXPECT_EQ(s.error().field, "output.rtae_hz");
  EXPECT_THAT(s.error().message(), HasSubstr("did you mean 'rate_hz'?"));
}

TEST(Config, RefusesRangeTypeNanAndMissing) {
  for (const char* text : {"noise_deg = 0", "noise_deg = nan", "noise_deg = -1", "noise_deg = 'x'",
                           "[output]\nrate_hz = 1000", "[output]\nrate_hz = 1.5", "[[item]]\n", "output = 3", "a = "}) {
    EXPECT_FALSE(parse(text)) << text;
  }
}

TEST(Config, OverridesFromTheCommandLine) {
  const auto s = parse("[output]\nrate_hz = 10\n", {"output.rate_hz=20", "output.file=b.csv"});
  ASSERT_TRUE(s) << s.error().message();
  EXPECT_EQ(s->rate, 20);
  EXPECT_EQ(s->file.written, "b.csv");
  EXPECT_FALSE(parse("", {"output.rate_hz"}));
}

TEST(Config, TemplateIsValidAndKeepsTheDefaults) {
  Sample s;
  const std::string text = config_template([&](ConfigVisitor& v) { describe(v, s); });
  const auto back = parse(text);
  ASSERT_TRUE(back) << text << back.error().message();
  EXPECT_DOUBLE_EQ(back->noise, s.noise);
  EXPECT_THAT(config_documentation([&](ConfigVisitor& v) { describe(v, s); }), HasSubstr("| `rate_hz` | integer, Hz | `5` | 1 to 100 |"));
}

}  // namespace
}  // namespace versine::app
