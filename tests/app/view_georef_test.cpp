// SPDX-License-Identifier: Apache-2.0
#include "versine/app/view_georef.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

namespace versine::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A journey over two tracks of 100 m with one alternative to the second of them.
class GeorefResult : public testing::Test {
 protected:
  GeorefResult() {
    fs::remove_all(folder);
    fs::create_directories(folder);
    const json line = {{9.0, 52.0, 0.0}, {9.0, 52.0009, 100.0}, {9.0, 52.0018, 200.0}};
    const auto track = [](const char* id, double from, double to) {
      return json{{"id", id}, {"line", id}, {"reversed", false}, {"from_m", from}, {"to_m", to}};
    };
    const auto path = [&](int n, double p, const char* second) {
      return json{{"path", n},
                  {"probability", p},
                  {"log_likelihood", -1.5 * n},
                  {"log_prior", 0},
                  {"from_m", 5},
                  {"to_m", 195},
                  {"line", line},
                  {"evidence", {{"position", 2.0}}},
                  {"tracks", {track("A", 0, 100), track(second, 100, 200)}}};
    };
    index = {{"format", "versine-georef 1"},
             {"network", {{"file", "map.gpkg"}, {"geojson", "network.geojson"}, {"crs", "EPSG:25832"}, {"tracks", 3}}},
             {"recordings",
              {{{"name", "run.h5"},
                {"journeys",
                 {{{"journey", 1},
                   {"from_s", 1000.0},
                   {"to_s", 1019.0},
                   {"length_m", 190.0},
                   {"fixes", 2},
                   {"paths", {path(1, 0.8, "B"), path(2, 0.2, "C")}},
                   {"ambiguous",
                    {{{"from_s", 1010.0},
                      {"to_s", 1019.0},
                      {"from_m", 100.0},
                      {"to_m", 195.0},
                      {"taken", {"B"}},
                      {"alternative", {"C"}},
                      {"paths", {2}},
                      {"probability", 0.2},
                      {"evidence", {{"position", 1.4}}}}}}}}}},
               {{"name", "other.h5"}, {"error", "no fix lies on the map"}}}}};
    write(folder / "georef.json", index.dump());
    write(folder / "network.geojson", R"({"type":"FeatureCollection","features":[
      {"type":"Feature","properties":{"id":"A"},"geometry":{"type":"LineString","coordinates":[[9,52],[9,52.0009]]}},
      {"type":"Feature","properties":{"id":"B"},"geometry":{"type":"LineString","coordinates":[[9,52.0009],[9,52.0018]]}},
      {"type":"Feature","properties":{"id":"C"},"geometry":{"type":"LineString","coordinates":[[9,52.0009],[9.0001,52.0018]]}}]})");
    write(folder / "positions.csv",
          "recording,journey,time_s,track,path_distance_m,speed_mps,sigma_m,sigma_speed_mps\n"
          "1,1,1000.0,A,5,0,0.5,0.1\n1,1,1010.0,B,100,19,0.4,0.1\n1,1,1019.0,B,195,1,0.5,0.1\n");
    write(folder / "fixes.csv",
          "recording,journey,time_s,latitude_deg,longitude_deg,sigma_m,status,along_m,across_m,sigma_along_m,"
          "sigma_across_m,nis,path_distance_m\n"
          "1,1,1001.0,52.0001,9,1.5,used,0.2,-0.3,1,1,0.1,6\n1,1,1012.0,52.0010,9.001,1.5,rejected,5,80,1,1,99,120\n");
  }
  ~GeorefResult() override {
    fs::remove_all(folder);
    fs::remove(constraints_file(folder));
  }
  Expected<ViewContent> open() {
    return open_georef_view(folder, R"({"format":"versine run 1","command":"georef"})", {});
  }

  fs::path folder = fs::temp_directory_path() / (std::string("versine-view-georef-") +
                                                 testing::UnitTest::GetInstance()->current_test_info()->name());
  json index;
};

TEST_F(GeorefResult, TellsJourneysPathsAndStretchesInMapMetres) {
  const auto view = open();
  ASSERT_TRUE(view) << view.error().message();
  const json result = json::parse(view->result_json());
  EXPECT_EQ(result["kind"], "georef");
  const json& georef = result["georef"];
  ASSERT_EQ(georef["journeys"].size(), 1U);
  const json& journey = georef["journeys"][0];
  EXPECT_EQ(journey["id"], "1.1");
  EXPECT_EQ(journey["count"], 3);
  const json& best = journey["hypotheses"][0];
  // 9 degrees east is the central meridian of UTM zone 32; latitude 52 lies 5761038.212 m north (GeographicLib).
  EXPECT_NEAR(best["easting"][0].get<double>(), 500000.0, 1e-3);
  EXPECT_NEAR(best["northing"][0].get<double>(), 5761038.212, 2e-3);
  EXPECT_EQ(journey["stretches"][0]["alternative"][0], "C");
  EXPECT_EQ(georef["failures"][0]["recording"], "other.h5");
  EXPECT_EQ(result["verdict"]["accepted"], false);
}

TEST_F(GeorefResult, SeriesCountFromTheJourneysBeginning) {
  const auto view = open();
  ASSERT_TRUE(view) << view.error().message();
  const auto speed = view->series("1.1:t:speed", -1e9, 1e9, 0);
  ASSERT_TRUE(speed);
  std::uint32_t n = 0;
  double x[3];
  float value[3];
  std::memcpy(&n, speed->data(), 4);
  ASSERT_EQ(n, 3U);
  std::memcpy(x, speed->data() + 8, sizeof x);
  std::memcpy(value, speed->data() + 8 + sizeof x, sizeof value);
  EXPECT_EQ(x[1], 10.0);
  EXPECT_EQ(value[1], 19.0f);
  EXPECT_FALSE(view->series("1.2:t:speed", 0, 1, 0));
  EXPECT_FALSE(view->series("1.1:t:nothing", 0, 1, 0));
}

TEST_F(GeorefResult, MapHasTheLinesAndTheFixesByStatus) {
  const auto view = open();
  ASSERT_TRUE(view) << view.error().message();
  const auto counts = [](const std::string& body) {
    std::array<std::uint32_t, 2> out{};
    std::memcpy(out.data(), body.data() + 16, 8);
    return out;
  };
  EXPECT_EQ(counts(*view->map("0")), (std::array<std::uint32_t, 2>{3, 6}));
  EXPECT_EQ(counts(*view->map("1.1")), (std::array<std::uint32_t, 2>{4, 2}));
  EXPECT_FALSE(view->map("9"));
}

TEST_F(GeorefResult, KeepsWhatAReviewerDecides) {
  const auto view = open();
  ASSERT_TRUE(view) << view.error().message();
  EXPECT_EQ(json::parse(view->constraints_json()), json::array());
  const json decided = json::array({{{"recording", "run.h5"},
                                     {"from_s", 1009.5},
                                     {"to_s", 1019.5},
                                     {"tracks", {"A", "C"}},
                                     {"excluded", false},
                                     {"comment", "a \"video\""}}});
  const auto done = view->put_constraints(decided.dump());
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(json::parse(view->constraints_json()), decided);
  for (const char* bad : {"{", R"([{"from_s":1,"to_s":0,"tracks":["A"]}])", R"([{"from_s":1,"to_s":2,"tracks":[]}])",
                          R"([{"from_s":1,"to_s":2,"tracks":[3]}])", "[4]"}) {
    EXPECT_FALSE(view->put_constraints(bad)) << bad;
  }
  EXPECT_EQ(json::parse(view->constraints_json()), decided);
}

TEST_F(GeorefResult, NeverReplacesAFileThatItDoesNotUnderstand) {
  const std::string broken = "[[constraint]]\nfrom_s = 1\nto_s = 2\ntrack = [\"A\"]\n";
  write(constraints_file(folder), broken);
  const auto view = open();
  ASSERT_TRUE(view) << view.error().message();
  const auto done = view->put_constraints(R"([{"from_s":1,"to_s":2,"tracks":["A"]}])");
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message().find("constraint[0].track"), std::string::npos) << done.error().message();
  std::ifstream file(constraints_file(folder));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), broken);
}

TEST_F(GeorefResult, SaysWhatIsWrongWithAFolder) {
  fs::remove(folder / "fixes.csv");
  EXPECT_NE(open().error().message().find("fixes.csv"), std::string::npos);
  index["recordings"][0]["journeys"][0].erase("from_s");
  write(folder / "georef.json", index.dump());
  EXPECT_NE(open().error().message().find("from_s"), std::string::npos);
  index["format"] = "versine-georef 7";
  write(folder / "georef.json", index.dump());
  EXPECT_NE(open().error().message().find("versine-georef 7"), std::string::npos);
  write(folder / "georef.json", "{");
  EXPECT_FALSE(open());
}

}  // namespace
}  // namespace versine::app
