#include "drivers/storage/flight_log.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "drivers/storage/text_file.h"
#include "drivers/storage/timed_columns.h"

namespace drivers {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr const char* kFlightHeader =
    "time(millisecond),datetime(utc), Latitude ,longitude,altitude_above_seaLevel(meters), compass_heading(degrees),"
    "message\n";
constexpr const char* kImuHeader = "SampleTimeFine,Euler_X,Euler_Y,Euler_Z,Acc_X,Acc_Y,Acc_Z,Gyr_X,\n";

class FlightLog : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / "flight_log" /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& text) const {
    const std::string path = (folder_ / "log.csv").string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  // 10 Hz, 100 ms to 60 s: latitude swings, altitude climbs, heading crosses north. `row` may change or drop a line.
  std::string write_flight(const std::function<std::string(int, std::string)>& row = {}) const {
    std::string text = kFlightHeader;
    for (int k = 1; k <= 600; ++k) {
      const double t = 0.1 * k;
      std::string line = fmt::format("{},2022-07-07 08:10:25,{:.13f},{:.13f},{:.4f}, {:.1f},\"hover, {}\"", 100 * k,
                                     45.0 + 1e-6 * std::sin(t), 11.0 + 2e-6 * std::cos(t), 100.0 + 0.01 * t,
                                     k % 2 == 0 ? 359.0 : 1.0, k);
      if (row) line = row(k, line);
      if (!line.empty()) text += line + "\n";
    }
    return write(text);
  }

  std::string write_imu(const std::function<std::string(int, std::string)>& row = {}) const {
    std::string text = kImuHeader;
    for (int k = 0; k < 1200; ++k) {
      const double yaw = 179.5 + 0.01 * k;  // crosses 180
      std::string line =
          fmt::format("{},{:.6f},2.5,{:.6f},{},{},{},0.1, ", 500000000 + 10000LL * k, 3.0 * std::sin(0.02 * k),
                      yaw > 180.0 ? yaw - 360.0 : yaw, k == 0 ? 0.0 : 0.5, k == 0 ? 0.0 : -0.25, k == 0 ? 0.0 : 9.81);
      if (row) line = row(k, line);
      if (!line.empty()) text += line + "\n";
    }
    return write(text);
  }

  std::filesystem::path folder_;
};

std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const FileError& e) {
    return e.what();
  }
  return "nothing refused";
}

TEST_F(FlightLog, SplitsAtCommasOutsideOfQuotes) {
  std::vector<std::string_view> cells;
  split_quoted_cells(" 1 ,\"a, b\", c,,", cells);
  ASSERT_EQ(cells.size(), 5U);
  EXPECT_EQ(cells[0], "1");
  EXPECT_EQ(cells[1], "a, b");
  EXPECT_EQ(cells[2], "c");
  EXPECT_EQ(cells[4], "");
}

TEST_F(FlightLog, PositionsComeInMillimetresAboutTheMean) {
  const core::FlightPath path = read_flight_path(write_flight(), 10.0, 40.0);
  EXPECT_NEAR(path.rate_hz, 10.0, 1e-9);
  EXPECT_DOUBLE_EQ(path.from_s, 10.0);
  ASSERT_EQ(path.n_samples(), 301U);
  // WGS 84 at 45 degrees: 111131.8 m per degree of latitude, 78846.8 m of longitude.
  const auto north = [](int k) { return 111131.8e-3 * std::sin(0.1 * k); };
  const auto east = [](int k) { return 2.0 * 78846.8e-3 * std::cos(0.1 * k); };
  EXPECT_NEAR(path.north_mm[50] - path.north_mm[0], north(150) - north(100), 2e-3);
  EXPECT_NEAR(path.east_mm[50] - path.east_mm[0], east(150) - east(100), 3e-3);
  EXPECT_NEAR(path.up_mm.back() - path.up_mm.front(), 300.0, 1e-6);
  for (const auto* series : {&path.north_mm, &path.east_mm, &path.up_mm}) {
    double sum = 0.0;
    for (const double value : *series) sum += value;
    EXPECT_NEAR(sum / 301.0, 0.0, 1e-5);
  }
  // 359 and 1 in turn: about north, not south.
  EXPECT_LT(std::min(path.mean_heading_deg, 360.0 - path.mean_heading_deg), 0.1);
}

TEST_F(FlightLog, TakesFeetCrlfAndTrailingCommas) {
  std::string text = "time(ms), latitude,longitude,altitude(feet),compass_heading(degrees)\r\n";
  for (int k = 0; k < 40; ++k) text += fmt::format("{},45,11,{},90,,,\r\n", 100 * k, 10 * k);
  const core::FlightPath path = read_flight_path(write(text), 0.0, 3.9);
  EXPECT_NEAR(path.up_mm[1] - path.up_mm[0], 3048.0, 1e-9);
}

TEST_F(FlightLog, OneMissingRowIsBridged) {
  const core::FlightPath path = read_flight_path(
      write_flight([](int k, const std::string& line) { return k == 200 ? std::string() : line; }), 10.0, 40.0);
  ASSERT_EQ(path.n_samples(), 301U);
  EXPECT_NEAR(path.north_mm[100], 0.5 * (path.north_mm[99] + path.north_mm[101]), 1e-5);
}

TEST_F(FlightLog, GapNamesLineAndSeconds) {
  const std::string path =
      write_flight([](int k, const std::string& line) { return k > 200 && k < 207 ? std::string() : line; });
  const std::string text = refusal([&] { (void)read_flight_path(path, 10.0, 40.0); });
  EXPECT_NE(text.find("log.csv:202: "), std::string::npos) << text;
  EXPECT_NE(text.find("0.7 s, from 20 to 20.7 s"), std::string::npos) << text;
  EXPECT_NE(text.find("choose a stretch"), std::string::npos) << text;
  EXPECT_EQ(read_flight_path(path, 21.0, 40.0).n_samples(), 191U);  // outside the gap the record is accepted
}

TEST_F(FlightLog, GapAmongTheFirstRowsIsFoundToo) {
  const std::string path =
      write_flight([](int k, const std::string& line) { return k > 101 && k < 120 ? std::string() : line; });
  EXPECT_NE(refusal([&] { (void)read_flight_path(path, 10.0, 40.0); }).find("from 10.1 to 12 s"), std::string::npos);
}

TEST_F(FlightLog, MissingColumnIsNamedWithThoseThatAreThere) {
  std::string text = "time(millisecond),latitude,altitude(meters),compass_heading(degrees)\n0,45,1,2\n";
  const std::string message = refusal([&] { (void)read_flight_path(write(text), 0.0, 1.0); });
  EXPECT_NE(message.find("log.csv:1: no column longitude"), std::string::npos) << message;
  EXPECT_NE(message.find("there are: time(millisecond), latitude"), std::string::npos) << message;
}

TEST_F(FlightLog, TextForANumberNamesLineAndColumnOnlyInsideTheStretch) {
  const std::string path = write_flight(
      [](int k, const std::string& line) { return k == 300 ? std::string("30000,x,45,11,n/a,90,m") : line; });
  const std::string text = refusal([&] { (void)read_flight_path(path, 10.0, 40.0); });
  EXPECT_NE(text.find("log.csv:301: altitude_above_seaLevel(meters): `n/a` is no number"), std::string::npos) << text;
  EXPECT_EQ(read_flight_path(path, 40.0, 50.0).n_samples(), 101U);
  EXPECT_NE(refusal([&] {
              (void)read_flight_path(
                  write_flight([](int k, const std::string& line) { return k == 300 ? std::string("30000,x") : line; }),
                  10.0, 40.0);
            }).find("end of the line"),
            std::string::npos);
}

TEST_F(FlightLog, TimesThatGoBackAreRefused) {
  const std::string path = write_flight(
      [](int k, const std::string& line) { return k == 300 ? "100" + line.substr(line.find(',')) : line; });
  EXPECT_NE(refusal([&] { (void)read_flight_path(path, 10.0, 40.0); }).find("times go back"), std::string::npos);
}

TEST_F(FlightLog, StretchOutsideOfTheRecordSaysWhatThereIs) {
  const std::string path = write_flight();
  const std::string beyond = refusal([&] { (void)read_flight_path(path, 50.0, 80.0); });
  EXPECT_NE(beyond.find("holds 0.1 to 60 s"), std::string::npos) << beyond;
  EXPECT_NE(beyond.find("only 50 to 60 s"), std::string::npos) << beyond;
  EXPECT_NE(refusal([&] { (void)read_flight_path(path, 70.0, 80.0); }).find("nothing"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)read_flight_path(path, 10.0, 10.5); }).find("at least 16"), std::string::npos);
}

TEST_F(FlightLog, NoPositionIsRefused) {
  const std::string path = write_flight(
      [](int k, const std::string& line) { return k == 300 ? std::string("30000,x,0,0,100,90,m") : line; });
  EXPECT_NE(refusal([&] { (void)read_flight_path(path, 10.0, 40.0); }).find("no position"), std::string::npos);
}

TEST_F(FlightLog, StretchMustBeATime) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string path = write_flight();
  EXPECT_THROW((void)read_flight_path(path, 40.0, 10.0), std::invalid_argument);
  EXPECT_THROW((void)read_flight_path(path, nan, 10.0), std::invalid_argument);
  EXPECT_THROW((void)read_flight_attitude(path, nan, 1.0, 2.0), std::invalid_argument);
}

TEST_F(FlightLog, EmptyMissingAndBinaryFilesAreRefused) {
  EXPECT_THROW((void)read_flight_path((folder_ / "none.csv").string(), 0.0, 1.0), FileError);
  EXPECT_THROW((void)read_flight_path(write(""), 0.0, 1.0), FileError);
  EXPECT_THROW((void)read_flight_path(write(kFlightHeader), 0.0, 1.0), FileError);
  EXPECT_THROW((void)read_flight_path(write(std::string("time\0x\n", 7)), 0.0, 1.0), FileError);
}

TEST_F(FlightLog, AttitudeStandsAtItsTimeOfTheFlightUnwrapped) {
  const core::FlightAttitude attitude = read_flight_attitude(write_imu(), 45.0, 45.0, 55.0);
  EXPECT_NEAR(attitude.rate_hz, 100.0, 1e-6);
  EXPECT_DOUBLE_EQ(attitude.from_s, 45.0);
  ASSERT_EQ(attitude.n_samples(), 1001U);
  EXPECT_NEAR(attitude.yaw_rad[1000] - attitude.yaw_rad[0], 10.0 * kRadPerDeg, 1e-6);
  EXPECT_NEAR(attitude.mean_pitch_rad, 2.5 * kRadPerDeg, 1e-9);
  EXPECT_NEAR(attitude.pitch_rad[7], 0.0, 1e-12);
  EXPECT_NEAR(attitude.mean_roll_rad + attitude.roll_rad[100], 3.0 * std::sin(2.0) * kRadPerDeg, 1e-7);
  EXPECT_EQ(attitude.n_replaced, 1U);  // the first row was not measured
  EXPECT_DOUBLE_EQ(attitude.z_m_s2[0], 9.81);
  EXPECT_DOUBLE_EQ(attitude.x_m_s2[500], 0.5);
}

TEST_F(FlightLog, AttitudeThatCoversAPartSaysWhichSeconds) {
  const std::string text = refusal([&] { (void)read_flight_attitude(write_imu(), 45.0, 50.0, 70.0); });
  EXPECT_NE(text.find("holds 45 to 56.99 s"), std::string::npos) << text;
  EXPECT_NE(text.find("only 50 to 56.99 s"), std::string::npos) << text;
}

}  // namespace
}  // namespace drivers
