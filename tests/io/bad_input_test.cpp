// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "../../src/io/read_from.hpp"
#include "versine/core/units.hpp"

namespace versine::io {
namespace {

constexpr const char* imu_header =
    "time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n";

std::string imu_text(std::size_t rows = 50) {
  std::string text = imu_header;
  for (std::size_t i = 0; i < rows; ++i)
    text += std::to_string(0.005 * static_cast<double>(i)) + ",0.001,0.002,-0.003,0.1,-0.2,-9.81\n";
  return text;
}

auto read_imu_text(std::string text, ImuFile file = {}) {
  return read_imu_from(LineReader::from_text(std::move(text), "imu.csv"), file);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, text.npos);
  return text.replace(at, from.size(), to);
}

// An Error must name file, line (where there is one) and the cure.
void expect_error(const Error& error, std::size_t line, std::string_view in_message) {
  EXPECT_EQ(error.file, "imu.csv");
  EXPECT_EQ(error.line, line);
  EXPECT_NE(error.message().find(in_message), std::string::npos) << error.message();
  EXPECT_FALSE(error.advice.empty());
}

TEST(BadInput, EmptyMissingAndFolder) {
  const auto folder = std::filesystem::temp_directory_path();
  const auto empty = folder / "versine_empty.csv";
  std::ofstream(empty).close();
  for (const auto& path : {empty, folder / "versine_no_such_file.csv", folder}) {
    ImuFile file;
    file.table.path = path;
    const auto read = read_imu(file);
    ASSERT_FALSE(read) << path;
    EXPECT_EQ(read.error().file, path.string());
    EXPECT_FALSE(read.error().advice.empty());
  }
  std::filesystem::remove(empty);
  EXPECT_FALSE(read_imu_text(imu_header));
  EXPECT_FALSE(read_imu_text("\n\n# nothing\n"));
}

TEST(BadInput, MissingColumnNamesTheNearest) {
  const auto read = read_imu_text(replaced(imu_text(), "gyro_z_radps", "gyro_zz_radps"));
  ASSERT_FALSE(read);
  expect_error(read.error(), 1, "gyro_zz_radps");
  EXPECT_NE(read.error().advice.find("[columns]"), std::string::npos);
}

TEST(BadInput, LettersInANumber) {
  const auto read = read_imu_text(replaced(imu_text(), "0.005000,0.001", "0.005000,0.0o1"));
  ASSERT_FALSE(read);
  expect_error(read.error(), 3, "0.0o1");
  EXPECT_EQ(read.error().field, "gyro_x_radps");
  expect_error(read_imu_text(replaced(imu_text(), "0.005000,", "0.005s,")).error(), 3, "0.005s");
}

TEST(BadInput, UnitOfAnotherQuantity) {
  const auto none = read_imu_text(replaced(imu_text(), "gyro_y_radps", "gyro_y"));
  ASSERT_FALSE(none);
  expect_error(none.error(), 1, "no unit");
  const auto other = read_imu_text(replaced(imu_text(), "gyro_y_radps", "gyro_y_mps"));
  ASSERT_FALSE(other);
  expect_error(other.error(), 1, "m/s");
}

TEST(BadInput, AxesMustBeRightHanded) {
  for (const char* bad : {"forward-left-down", "forward-right", "forward-forward-down", "x-y-z", ""}) {
    ImuFile file;
    file.axes = bad;
    const auto read = read_imu_text(imu_text(), file);
    ASSERT_FALSE(read) << bad;
    EXPECT_EQ(read.error().field, "axes");
  }
}

TEST(BadInput, NanFieldsAndCutLinesAreFindings) {
  std::string text = replaced(imu_text(), "0.005000,0.001", "0.005000,nan");
  text = replaced(text, "0.010000,0.001,0.002", "0.010000,,0.002");
  text += "0.25,0.001,0.0";  // cut short by a power failure
  const auto read = read_imu_text(text);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->series.size(), 48u);
  ASSERT_EQ(read->record.findings.size(), 2u);
  EXPECT_EQ(read->record.findings[0].kind, "not a number");
  EXPECT_EQ(read->record.findings[0].count, 2u);
  EXPECT_EQ(read->record.findings[1].kind, "line cut short");
  EXPECT_NE(read->record.findings[1].detail.find("line 52"), std::string::npos);
}

TEST(BadInput, TooManyBadLinesAreNotThatFormat) {
  std::string text = imu_header;
  for (int i = 0; i < 20; ++i) text += "1,2,3\n";
  EXPECT_FALSE(read_imu_text(text));
}

TEST(BadInput, BinaryAndUtf16AreNamed) {
  EXPECT_NE(read_imu_text(std::string("t\0i\0m\0e\0", 8)).error().message().find("not text"), std::string::npos);
}

TEST(Tables, DelimitersDecimalsQuotesCommentsAndLineEnds) {
  const auto expected = read_imu_text(imu_text());
  ASSERT_TRUE(expected);
  const auto same = [&](std::string text, const char* what) {
    const auto read = read_imu_text(std::move(text));
    ASSERT_TRUE(read) << what << ": " << read.error().message();
    ASSERT_EQ(read->series.size(), expected->series.size()) << what;
    for (std::size_t i = 0; i < read->series.size(); ++i) {
      EXPECT_EQ(read->series[i].time, expected->series[i].time) << what;
      EXPECT_EQ(read->series[i].dvel, expected->series[i].dvel) << what;
    }
  };
  const auto with = [](std::string text, char from, const std::string& to) {
    std::string out;
    for (const char c : text) c == from ? out += to : out += c;
    return out;
  };
  same(with(imu_text(), ',', ";"), "semicolon");
  same(with(imu_text(), ',', "\t"), "tab");
  same(with(imu_text(), ',', "   "), "blanks");
  same(with(imu_text(), ',', " , "), "blanks around commas");
  same(with(imu_text(), '\n', "\r\n"), "CRLF");
  same("\xef\xbb\xbf" + imu_text(), "byte order mark");
  same("# made by hand\n% and more\n\n" + imu_text(), "comments");
  same("# " + imu_text(), "header in a comment");
  same(with(with(imu_text(), ',', ";"), '.', ","), "decimal comma");
  std::string last = imu_text();
  last.pop_back();
  same(last, "no end of the last line");
  same(replaced(imu_text(), "time_s", "\"time_s\""), "quotes");
  same(replaced(imu_text(), "gyro_x_radps", "Gyro X [rad/s]"), "units in brackets");
}

TEST(Tables, ColumnsByNumberAndCounts) {
  ImuFile file;
  file.table.columns = {{"time_ms", "1"},    {"dtheta_x_count", "2"}, {"dtheta_y_count", "3"}, {"dtheta_z_count", "4"},
                        {"dvel_x_mps", "7"}, {"dvel_y_mps", "6"},     {"dvel_z_mps", "5"}};
  file.gyro_scale = 0.1 * units::arcsec;
  const auto read = read_imu_text("261916 10 -20 30 -0.1 0.02 0.01\n261926 10 -20 30 -0.1 0.02 0.01\n", file);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->series[1].time.ns, 261'926'000'000);
  EXPECT_DOUBLE_EQ(read->series[0].dtheta.y(), -2.0 * units::arcsec);
  EXPECT_EQ(read->series[0].dvel, Eigen::Vector3d(0.01, 0.02, -0.1));
  EXPECT_EQ(read->series.content, sensors::ImuContent::increments);
}

TEST(Tables, KfGinsLayout) {
  ImuFile file;
  file.format = ImuFile::Format::kf_gins;
  const auto imu = read_imu_text(
      "456300.005 1e-5 2e-5 3e-5 0.001 0.002 -0.049\n456300.010 1e-5 2e-5 3e-5 0.001 0.002 -0.049\n", file);
  ASSERT_TRUE(imu) << imu.error().message();
  EXPECT_EQ(imu->series[1].time.ns, 456'300'010'000'000);
  GnssFile gnss;
  gnss.format = GnssFile::Format::kf_gins;
  const auto fixes =
      read_gnss_from(LineReader::from_text("456300.00 30.4447873701 114.4718632047 20.899 0.01 0.01 0.02\n"), gnss);
  ASSERT_TRUE(fixes) << fixes.error().message();
  EXPECT_NEAR(fixes->series[0].position.longitude, 114.4718632047 * units::deg, 1e-15);
  EXPECT_EQ(fixes->series.scale, imu->series.scale);
}

TEST(Times, RollOversAndClocks) {
  ImuFile file;
  file.table.clock.gps_week = 2374;
  file.table.clock.offset_s = -0.125;
  const auto text = replaced(imu_text(0), "time_s", "tow_s") +
                    "604799.995,0,0,0,0,0,-9.8\n0.000,0,0,0,0,0,-9.8\n0.005,0,0,0,0,0,-9.8\n";
  const auto read = read_imu_text(text, file);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ((read->series[2].time - read->series[0].time).ns, 10'000'000);
  EXPECT_EQ(read->series[0].time.ns, 2374ll * 604'800'000'000'000 + 604'799'870'000'000);
  EXPECT_EQ(read->series.scale, TimeScale::gps);
  // Ten digits of seconds keep their nanoseconds, which a double would not.
  const auto big = read_imu_text(std::string(imu_header) +
                                 "1436038476.000000001,0,0,0,0,0,-9.8\n1436038476.005000001,0,0,0,0,0,-9.8\n");
  EXPECT_EQ(big->series[0].time.ns, 1'436'038'476'000'000'001);
  EXPECT_EQ(big->series.scale, TimeScale::gps);
  ImuFile drifting;
  drifting.table.clock.drift_ppm = 100.0;
  EXPECT_EQ(read_imu_text(imu_text(), drifting)->series[40].time.ns, 200'020'000);
}

GnssFile nmea_file() {
  GnssFile file;
  file.sigma_horizontal = 0.5;
  file.sigma_vertical = 1.0;
  file.sigma_velocity = 0.1;
  return file;
}

auto read_nmea_text(const std::string& text, const GnssFile& file = nmea_file()) {
  return read_gnss_from(LineReader::from_text(text, "log.nmea"), file);
}

std::string with_checksum(const std::string& body) {
  unsigned x = 0;
  for (const char c : body) x ^= static_cast<unsigned char>(c);
  char sum[8];
  std::snprintf(sum, sizeof sum, "*%02X", x);
  return "$" + body + sum + "\r\n";
}

TEST(Nmea, DayRollOverChecksumsAndSigmas) {
  std::string text = with_checksum("GPGGA,235959.00,4807.0380,N,01131.0000,W,4,12,0.9,545.4,M,46.9,M,,") +
                     with_checksum("GPRMC,235959.00,A,4807.0380,N,01131.0000,W,22.4,084.4,311216,,,A") +
                     with_checksum("GPGGA,000000.00,4807.0390,N,01131.0000,W,1,08,0.9,545.4,M,46.9,M,,") +
                     with_checksum("GPGST,000000.00,,,,,0.011,0.012,0.025");
  text += replaced(with_checksum("GPGGA,000001.00,4807.0390,N,01131.0000,W,1,08,0.9,545.4,M,46.9,M,,"), "4807", "4808");
  const auto read = read_nmea_text(text);
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->series.size(), 2u);
  const auto& a = read->series[0];
  const auto& b = read->series[1];
  EXPECT_EQ((b.time - a.time).ns, 2'000'000'000);  // the leap second at the end of 2016 lies between
  EXPECT_NEAR(a.position.latitude, (48.0 + 7.038 / 60.0) * units::deg, 1e-15);
  EXPECT_NEAR(a.position.longitude, -(11.0 + 31.0 / 60.0) * units::deg, 1e-15);
  EXPECT_DOUBLE_EQ(a.position.height, 592.3);
  EXPECT_EQ(a.fix, sensors::FixType::fixed);
  ASSERT_TRUE(a.v_ned);
  EXPECT_NEAR(a.v_ned->norm(), 22.4 * 1852.0 / 3600.0, 1e-12);
  EXPECT_EQ(b.sigma_ned, Eigen::Vector3d(0.011, 0.012, 0.025));
  ASSERT_EQ(read->record.findings.size(), 1u);
  EXPECT_EQ(read->record.findings[0].kind, "checksum");
}

TEST(Nmea, WithoutDateOrSigmaIsAnError) {
  const std::string gga = with_checksum("GPGGA,235959.00,4807.0380,N,01131.0000,W,4,12,0.9,545.4,M,46.9,M,,");
  ASSERT_FALSE(read_nmea_text(gga));
  EXPECT_NE(read_nmea_text(gga).error().advice.find("date"), std::string::npos);
  GnssFile file;
  file.format = GnssFile::Format::nmea;
  file.table.clock.date = "2025-07-08";
  ASSERT_FALSE(read_nmea_text(gga, file));
  EXPECT_NE(read_nmea_text(gga, file).error().advice.find("sigma"), std::string::npos);
}

constexpr const char* pos_header =
    "%  GPST  latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)   sdu(m)  sdne(m)  sdeu(m)  sdun(m) "
    "age(s)  ratio\n";

TEST(Rtklib, WeekAndDateUtcAndDms) {
  const auto read = [](const std::string& text) { return read_gnss_from(LineReader::from_text(text, "a.pos"), {}); };
  const std::string rest = "  35.1 139.2 50.0 1 9 0.01 0.02 0.03 0 0 0 0 99\n";
  const auto week = read(pos_header + std::string("2374 243258.499") + rest);
  const auto date = read(pos_header + std::string("2025/07/08 19:34:18.499") + rest);
  ASSERT_TRUE(week && date);
  EXPECT_EQ(week->series[0].time, date->series[0].time);
  EXPECT_FLOAT_EQ(week->series[0].ratio, 99.0f);
  const auto utc = read(replaced(pos_header, "GPST", "UTC ") + "2025/07/08 19:34:00.499" + rest);
  EXPECT_EQ(utc->series[0].time, date->series[0].time);
  const auto dms =
      read(replaced(replaced(pos_header, "latitude(deg)", "latitude(d'\")"), "longitude(deg)", "longitude(d'\")") +
           "2374 243258.499  -0 6 0 139 12 0 50.0 1 9 0.01 0.02 0.03 0 0 0 0 99\n");
  ASSERT_TRUE(dms) << dms.error().message();
  EXPECT_NEAR(dms->series[0].position.latitude, -0.1 * units::deg, 1e-15);
  const auto swapped =
      read(pos_header + std::string("2374 243258.499  139.2 35.1 50.0 1 9 0.01 0.02 0.03 0 0 0 0 99\n"));
  ASSERT_FALSE(swapped);
  EXPECT_EQ(swapped.error().line, 2u);
  const auto with_sigmas = [&](const std::string& sigmas) {
    return read(pos_header + std::string("2374 243258.499  35.1 139.2 50.0 1 9 ") + sigmas + " 0 0 0 0 99\n");
  };
  const auto negative = with_sigmas("-0.01 0.02 0.03");
  ASSERT_FALSE(negative);
  EXPECT_NE(negative.error().message().find("positive"), std::string::npos);
  // RTKLIB writes zeros where it has no sigma: such a row is passed over, and a file of nothing else has no solution.
  EXPECT_FALSE(with_sigmas("0 0 0"));
  EXPECT_TRUE(with_sigmas("0.0000 0.0001 0.0002"));  // rounded to tenths of a millimetre
}

TEST(Gnss, SwappedCoordinatesBeyondTheirRangeAndBadSigma) {
  const std::string header = "time_s,latitude_deg,longitude_deg,height_m,sigma_north_m,sigma_east_m,sigma_down_m\n";
  const auto read = [&](const std::string& row) {
    return read_gnss_from(LineReader::from_text(header + row, "imu.csv"), {});
  };
  expect_error(read("0,139.2,35.1,50,0.01,0.01,0.02\n").error(), 2, "swapped");
  expect_error(read("0,35.1,139.2,50,0.01,0,0.02\n").error(), 2, "positive");
  expect_error(read("0,35.1,139.2,50,0.01,-0.1,0.02\n").error(), 2, "positive");
}

// A small change of a good file anywhere must give an Error or finite numbers, never a crash or a NaN.
template <class Reader>
void mutate(const std::string& text, Reader reader) {
  std::mt19937 random(7);
  const std::string alphabet = "0123456789.,;-+eE \t\n\r\"%#$*nNaifxX\xff\x01";
  for (int round = 0; round < 3000; ++round) {
    std::string changed = text;
    for (unsigned k = 0; k <= random() % 3; ++k) {
      const std::size_t at = random() % changed.size();
      switch (random() % 4) {
        case 0:
          changed[at] = alphabet[random() % alphabet.size()];
          break;
        case 1:
          changed.erase(at, 1 + random() % 20);
          break;
        case 2:
          changed.insert(at, 1 + random() % 3, alphabet[random() % alphabet.size()]);
          break;
        default:
          changed.resize(at + 1);
          break;
      }
    }
    reader(changed);
  }
}

TEST(Mutations, NeverCrashAndNeverGiveNan) {
  mutate(imu_text(), [](const std::string& text) {
    if (const auto read = read_imu_text(text)) {
      for (const auto& s : read->series) ASSERT_TRUE(s.dtheta.allFinite() && s.dvel.allFinite()) << text;
    }
  });
  const auto finite = [](const auto& read, const std::string& text) {
    if (!read) return;
    for (const auto& s : read->series) {
      ASSERT_TRUE(std::isfinite(s.position.latitude + s.position.longitude + s.position.height)) << text;
      ASSERT_GT(s.sigma_ned.minCoeff(), 0.0) << text;
    }
  };
  std::string pos = pos_header, nmea;
  for (int i = 0; i < 10; ++i) {
    pos += "2374 24325" + std::to_string(i) +
           ".499  35.1 139.2 50.0 1 9 0.01 0.02 0.03 0 0 0 0 99 1 2 3 0.1 0.1 0.1 0 0 0\n";
    nmea += with_checksum("GPGGA,23595" + std::to_string(i) + ".00,4807.0380,N,01131.0000,W,4,12,0.9,545.4,M,46.9,M,,");
    nmea += "$GPRMC,23595" + std::to_string(i) + ".00,A,4807.0380,N,01131.0000,W,22.4,084.4,311216,,,A\n";
  }
  mutate(pos, [&](const std::string& text) { finite(read_gnss_from(LineReader::from_text(text), {}), text); });
  mutate(nmea, [&](const std::string& text) { finite(read_nmea_text(text), text); });
}

}  // namespace
}  // namespace versine::io
