// SPDX-License-Identifier: Apache-2.0
#include "versine/batch/store.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>

#include "versine/batch/catalogue.hpp"
#include "versine/batch/housekeeping.hpp"
#include "versine/batch/run.hpp"
#include "versine/io/sha256.hpp"

namespace versine::batch {
namespace {

namespace fs = std::filesystem;

class StoreTest : public testing::Test {
 protected:
  StoreTest()
      : folder(fs::path(testing::TempDir()) /
               ("versine-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    fs::remove_all(folder);
    store = *Store::open(folder, true);
  }
  ~StoreTest() override { fs::remove_all(folder); }

  static Manifest of(const std::vector<std::uintmax_t>& sizes, int shards) {
    std::vector<std::vector<Input>> inputs;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      inputs.push_back({{"/data/" + std::to_string(i), io::sha256(std::to_string(i)), sizes[i]}});
    }
    return make_manifest("engine 1", "stage", {"/job.toml", "a = 1\n", "c0"}, inputs, shards);
  }

  fs::path folder;
  std::optional<Store> store;
};

TEST_F(StoreTest, DigestOfTheStandardsExample) {
  EXPECT_EQ(io::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(StoreTest, ObjectsAreNamedByContentAndDamageIsSeen) {
  const auto name = store->put("abc");
  ASSERT_TRUE(name);
  EXPECT_EQ(*name, io::sha256("abc"));
  EXPECT_EQ(*store->get(*name), "abc");
  EXPECT_TRUE(fs::is_empty(store->tmp()));
  std::ofstream(store->object(*name)) << "abd";
  EXPECT_EQ(store->get(*name).error().exit, Exit::again);
  ASSERT_TRUE(store->put("abc"));  // mends it
  EXPECT_EQ(*store->get(*name), "abc");
}

TEST_F(StoreTest, SecondExecutionIsADuplicateOrDiffers) {
  Receipt r{std::string(64, 'a'), {{"summary", std::string(64, '1'), 5}}, {}};
  EXPECT_EQ(*commit(*store, r), Commit::created);
  EXPECT_EQ(*commit(*store, r), Commit::duplicate);
  const auto before = *read_file(store->receipt(r.unit));
  r.outputs[0].bytes = 6;
  const auto other = commit(*store, r);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().exit, Exit::differs);
  EXPECT_EQ(*read_file(store->receipt(r.unit)), before);  // the first stands
  EXPECT_TRUE(fs::is_empty(store->tmp()));
}

TEST_F(StoreTest, ReceiptsComeBackAndAnyFlippedByteIsFound) {
  const Receipt r{std::string(64, 'b'), {}, Error{"", 3, "time_s", "'x' is \"no\" number", "a number", "remove it"}};
  const std::string text = to_text(r);
  const auto back = receipt_from(text);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->rejection->found, r.rejection->found);
  EXPECT_EQ(back->rejection->line, 3u);
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string bad = text;
    bad[i] = static_cast<char>(bad[i] ^ 1);
    EXPECT_FALSE(receipt_from(bad)) << i;
  }
}

TEST_F(StoreTest, LongestFirstOntoTheLeastLoaded) {
  const Manifest m = of({7, 1, 5, 3, 4, 2}, 2);
  std::array<std::uintmax_t, 2> load{};
  for (const Unit& u : m.units) load[static_cast<std::size_t>(u.shard)] += u.weight;
  EXPECT_EQ(load[0], 11u);
  EXPECT_EQ(load[1], 11u);
  EXPECT_TRUE(std::is_sorted(m.units.begin(), m.units.end(), [](auto& a, auto& b) { return a.unit < b.unit; }));
}

TEST_F(StoreTest, ManifestsAreTheSameForTheSamePlanAndFoundByTheirBeginning) {
  Manifest m = of({7, 1, 5}, 2);
  ASSERT_TRUE(write_manifest(*store, m));
  const auto back = read_manifest(*store, m.id.substr(0, 8));
  ASSERT_TRUE(back) << back.error().error.message();
  EXPECT_EQ(back->units.size(), 3u);
  EXPECT_EQ(back->job.text, "a = 1\n");
  EXPECT_EQ(back->units[1].inputs[0].sha256, m.units[1].inputs[0].sha256);
  Manifest again = of({7, 1, 5}, 2);
  ASSERT_TRUE(write_manifest(*store, again));
  EXPECT_EQ(again.id, m.id);
  // Other settings: other units, none of whose receipts count.
  EXPECT_NE(unit_name("engine 1", "c1", "stage", m.units[0].inputs), m.units[0].unit);
  EXPECT_NE(unit_name("engine 2", "c0", "stage", m.units[0].inputs), m.units[0].unit);
  std::ofstream(store->manifests() / m.id / "manifest.json", std::ios::app) << " ";
  EXPECT_EQ(read_manifest(*store, "").error().exit, Exit::changed);
}

TEST_F(StoreTest, SweepsSplitByNameCoverEachUnitOnce) {
  const Manifest m = of(std::vector<std::uintmax_t>(200, 10), 4);
  std::multiset<std::size_t> seen;
  for (int i = 0; i < 3; ++i) {
    const auto units = *select_units(*store, m, {Shard{i, 3}, true});
    seen.insert(units.begin(), units.end());
  }
  EXPECT_EQ(seen.size(), 200u);
  EXPECT_EQ(std::set<std::size_t>(seen.begin(), seen.end()).size(), 200u);
  // The same unit is in the same part, whatever else is missing.
  const auto part = *select_units(*store, m, {Shard{1, 3}, true});
  ASSERT_TRUE(commit(*store, {m.units[part[0]].unit, {}, Error{}}));
  auto fewer = *select_units(*store, m, {Shard{1, 3}, true});
  EXPECT_EQ(fewer.size(), part.size() - 1);
  EXPECT_EQ(select_units(*store, m, {Shard{1, 3}, false}).error().exit, Exit::usage);
}

TEST_F(StoreTest, RejectedOnceIsNeverTriedAgain) {
  Manifest m = of({1, 2, 3}, 1);
  ASSERT_TRUE(write_manifest(*store, m));
  int tries = 0;
  const Stage stage = [&](const Unit& u) -> Outcome<Made> {
    ++tries;
    if (u.weight == 2) return Made{{}, Error{.found = "nonsense"}};
    return Made{{{"summary", "x" + u.unit}}, {}};
  };
  for (int round = 0; round < 2; ++round) {
    auto units = *select_units(*store, m, {});
    std::size_t i = 0;
    const auto exit = run_units(
        *store, m, stage, [&] { return i < units.size() ? std::optional(units[i++]) : std::nullopt; },
        [] { return false; }, [](const Done&) {});
    EXPECT_EQ(exit, Exit::done);
  }
  EXPECT_EQ(tries, 3);
  const auto s = status(*store, m);
  EXPECT_EQ(s->done, 2u);
  EXPECT_EQ(s->rejected, 1u);
  EXPECT_EQ(s->exit(), Exit::rejected);
  // An object that no receipt names is garbage; the others stay.
  ASSERT_TRUE(store->put("orphan"));
  ASSERT_TRUE(store->write_tmp("left by a killed worker"));
  EXPECT_EQ(collect_garbage(*store, 3600.0)->objects, 0u);
  const auto c = collect_garbage(*store, 0.0);
  EXPECT_EQ(c->objects, 1u);
  EXPECT_EQ(c->tmp, 1u);
  EXPECT_TRUE(verify(*store)->withdrawn.empty());
}

TEST_F(StoreTest, FifthAttemptGivesUp) {
  EXPECT_EQ(after_attempts(Exit::again, 4), Exit::again);
  EXPECT_EQ(after_attempts(Exit::again, 5), Exit::failed);
  EXPECT_EQ(after_attempts(Exit::changed, 5), Exit::changed);
  EXPECT_EQ(graver(Exit::again, Exit::differs), Exit::differs);
}

TEST(Pass, TimeAndSpeedAtAMetre) {
  // d = 100 - 2 t - 0.25 t^2 against the line: a cubic with end speeds reproduces it.
  Pass p{"A", 1.0, {}};
  for (const double t : {0.0, 4.0, 10.0}) {
    p.knots.push_back({Time::from_seconds(t), 100.0 - 2.0 * t - 0.25 * t * t, -2.0 - 0.5 * t, 0.1 * t});
  }
  for (const double t : {0.0, 1.0, 3.9, 5.0, 9.99}) {
    const auto k = knot_at(p, 100.0 - 2.0 * t - 0.25 * t * t);
    ASSERT_TRUE(k);
    EXPECT_NEAR(k->time.seconds(), t, 1e-6);
    EXPECT_NEAR(k->speed, -2.0 - 0.5 * t, 1e-6);
  }
  EXPECT_FALSE(knot_at(p, 101.0));
  EXPECT_FALSE(knot_at(p, 54.9));
}

}  // namespace
}  // namespace versine::batch
