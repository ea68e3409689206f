#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "tests/support/answers.h"
#include "tests/support/command.h"
#include "tests/support/folder_test.h"

// `hovermodal compare --sensor` as a user runs it.
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using tests::Outcome;

// A roof of 1.7, 4.1 and 7.3 Hz with slowly wandering amplitudes, mm.
double roof_mm(double t) {
  double sum = 0.0;
  for (const double f : {1.7, 4.1, 7.3}) sum += std::sin(6.283185307 * f * t + 3.0 * std::sin(0.37 * t + f)) / f;
  return sum;
}

class CompareSensor : public tests::FolderTest {
 protected:
  void SetUp() override {
    tests::FolderTest::SetUp();
    fs::create_directories(folder_ / "run");
    std::mt19937_64 random(3);
    std::normal_distribution<double> gaussian;
    std::ofstream table(folder_ / "run" / "displacements.csv");
    table << "# unit: mm\n# rate_hz: 25\n# row_delay_s.roof: 0.01\nframe,t_s,scale_mm_per_px,roof,base\n";
    for (int k = 0; k < 1500; ++k)
      table << k << ',' << k / 25.0 << ",2," << roof_mm(k / 25.0 + 0.012) + 0.01 * gaussian(random) << ",0.1\n";
    std::ofstream(folder_ / "run" / "tracks.csv") << "# exposure_ms: 4\nframe,t_s,point,region,u_px,v_px,sigma_px\n";
    std::ofstream laser(folder_ / "laser.csv");
    laser << "t_s,laser [m]\n";
    for (int k = 0; k < 12000; ++k) laser << 100.0 + k / 200.0 << ',' << 1e-3 * roof_mm(k / 200.0 + 0.5) << '\n';
  }
  Outcome compare(const std::string& more) {
    return tests::run("hovermodal", "compare --sensor " + (folder_ / "laser.csv").string() + " --run " +
                                        (folder_ / "run").string() + " " + more);
  }
};

TEST_F(CompareSensor, PrintsItsFileAsJson) {
  const auto told = tests::expect_answers("compare --sensor " + (folder_ / "laser.csv").string() + " --run " +
                                          (folder_ / "run").string() + " --channel roof --band 1 9 --report " +
                                          (folder_ / "proof").string());
  EXPECT_EQ(told, nlohmann::json::parse(tests::read(folder_ / "proof" / "sensor.json")));
}

TEST_F(CompareSensor, ALaserInMetresOnItsOwnClockAgrees) {
  const Outcome outcome = compare("--channel roof --band 1 9 --report " + (folder_ / "proof").string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  const auto json = nlohmann::json::parse(tests::read(folder_ / "proof" / "sensor.json"));
  // The laser's clock shows 100 s at 0.5 s of the camera's; delay and half the exposure are accounted for.
  EXPECT_NEAR(json["offset_s"].get<double>(), 99.5, 4.0 * json["offset_std_s"].get<double>() + 1e-5);
  EXPECT_NEAR(json["rmse"].get<double>(), 0.01 * std::sqrt(8.0 / 12.5), 0.0015);
  EXPECT_NEAR(json["rmse_px"].get<double>(), json["rmse"].get<double>() / 2.0, 1e-12);
  EXPECT_NEAR(json["amplitude_ratio"].get<double>(), 1.0, 4.0 * json["amplitude_ratio_std"].get<double>());
  EXPECT_THAT(tests::read(folder_ / "proof" / "sensor.svg"), HasSubstr("Channel against sensor"));
  EXPECT_THAT(outcome.text, HasSubstr("mm/px"));
}

TEST_F(CompareSensor, WhatIsMissingIsNamedWithItsRemedy) {
  EXPECT_THAT(compare("").text, HasSubstr("choose one by --channel: roof, base"));
  EXPECT_THAT(compare("--channel roof --band 3").text, HasSubstr("--band"));
  std::ofstream laser(folder_ / "laser.csv");
  laser << "t_s,laser\n";
  for (int k = 0; k < 12000; ++k) laser << k / 200.0 << ',' << roof_mm(k / 200.0) << '\n';
  laser.close();
  const Outcome no_unit = compare("--channel roof --band 1 9");
  EXPECT_EQ(no_unit.exit_code, 2);
  EXPECT_THAT(no_unit.text, HasSubstr("--sensor-unit"));
  EXPECT_THAT(compare("--channel roof --band 1 9 --quantity d").text, HasSubstr("its bias is not known"));
  const Outcome with_unit =
      compare("--channel roof --band 1 9 --sensor-unit mm --report '" + (folder_ / "two").string() + "'");
  EXPECT_EQ(with_unit.exit_code, 0) << with_unit.text;
  EXPECT_THAT(with_unit.text, Not(HasSubstr("no unit known"))) << "it was named";
  EXPECT_EQ(tests::run("hovermodal", "compare").exit_code, 2);
}

}  // namespace
