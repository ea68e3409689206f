// `hovermodal changes` as a user runs it, on modal.json files written here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/simulation/random_stream.h"
#include "firmware_app/report/modal_json.h"
#include "tests/support/command.h"
#include "tests/support/folder_test.h"

namespace {

using testing::HasSubstr;
using testing::Not;

class Changes : public tests::FolderTest {
 protected:
  // A flight whose frequencies are `factor` times those of the structure, each with noise of its sigma.
  void write_flight(const std::string& name, double factor, std::uint64_t seed) const {
    core::simulation::RandomStream noise(seed, "flight");
    app::ModalReport report;
    report.method = "hovermodal";
    report.channel_names = {"roof", "middle", "low"};
    report.estimate.status = "ok", report.estimate.rate_hz = 30.0, report.estimate.duration_s = 120.0;
    report.estimate.degrees_of_freedom = 8.0;
    const std::vector<std::vector<std::complex<double>>> shapes{{1.0, 0.7, 0.3}, {1.0, -0.6, -0.8}};
    const std::vector<double> hz{1.5, 4.4};
    for (std::size_t m = 0; m < hz.size(); ++m) {
      core::Mode& mode = report.estimate.modes.emplace_back();
      mode.frequency_hz = mode.apparent_hz = hz[m] * factor * (1.0 + 1e-3 * noise.gaussian());
      mode.frequency_std_hz = 1e-3 * hz[m];
      mode.damping_ratio = 0.01 * (1.0 + 0.1 * noise.gaussian());
      mode.damping_std = 0.001;
      mode.shape = shapes[m];
      for (std::size_t c = 1; c < 3; ++c) mode.shape[c] += 0.005 * noise.gaussian();
      mode.shape_std = {0.0, 0.005, 0.005};
      mode.mpc = 1.0, mode.verdict = core::Verdict::kStructural;
    }
    std::ofstream(folder_ / (name + ".json")) << app::modal_json(report);
  }

  // A table of one flight a month.
  void write_flights(const std::vector<double>& factor) const {
    std::ofstream table(folder_ / "flights.csv");
    table << "report,date,temperature_c\n";
    for (std::size_t k = 0; k < factor.size(); ++k) {
      const std::string name = fmt::format("f{:02}", k + 1);
      write_flight(name, factor[k], k + 1);
      table << fmt::format("{}.json,20{:02}-{:02}-15,\n", name, 24 + k / 12, 1 + k % 12);
    }
  }

  [[nodiscard]] tests::Outcome run(const std::string& more = "") const {
    return tests::run("hovermodal", "changes " + (folder_ / "flights.csv").string() + more);
  }
};

TEST_F(Changes, AStepIsAnAlarmWithItsDate) {
  std::vector<double> factor(16, 1.0);
  std::fill(factor.begin() + 9, factor.end(), 0.99);
  write_flights(factor);
  const auto outcome = run(" --out " + (folder_ / "out").string());
  EXPECT_EQ(outcome.exit_code, 3) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("step at flight 10 (2024-10-15): -1"));
  EXPECT_THAT(outcome.text, HasSubstr("CHANGED"));
  std::ifstream file(folder_ / "out/changes.json");
  const auto json = nlohmann::json::parse(file);
  EXPECT_TRUE(json["changed"]);
  EXPECT_EQ(json["modes"][0]["frequency_hz"]["first_flight_after"], "f10.json");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/changes.svg"));
}

TEST_F(Changes, AStructureThatStaysIsNoneAndAWrongClockIsNamed) {
  std::vector<double> factor(12, 1.0);
  factor[4] = 1.2;  // 25 frames/s stated for 30
  factor[8] = 0.98;
  write_flights(factor);
  const auto outcome = run();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("flight 5 (2024-05-15) contradicts the others: all its 2 modes lie"));
  EXPECT_THAT(outcome.text, HasSubstr("flight 9 (2024-09-15) contradicts the others: all its 2 modes lie"));
  EXPECT_THAT(outcome.text, HasSubstr("no change found"));
}

TEST_F(Changes, ALossThatMovesAModeBeyondItsNeighboursIsOneMode) {
  std::vector<double> factor(12, 1.0);
  std::fill(factor.begin() + 6, factor.end(), 0.92);
  write_flights(factor);
  const auto outcome = run();
  EXPECT_EQ(outcome.exit_code, 3) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("step at flight 7"));
}

TEST_F(Changes, AFolderIsReadByNames) {
  for (std::size_t k = 0; k < 3; ++k) {
    write_flight("modal", 1.0, k);
    std::filesystem::create_directories(folder_ / "flights" / fmt::format("run{}", k));
    std::filesystem::rename(folder_ / "modal.json", folder_ / "flights" / fmt::format("run{}", k) / "modal.json");
  }
  const auto outcome = tests::run("hovermodal", "changes " + (folder_ / "flights").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("3 flights, run0 to run2"));
  EXPECT_THAT(outcome.text, HasSubstr("not tested: fewer than 6 flights"));
}

TEST_F(Changes, FaultsOfTheTableAreNamed) {
  write_flight("f01", 1.0, 1);
  const auto refused = [&](const std::string& text) {
    std::ofstream(folder_ / "flights.csv") << text;
    const auto outcome = run();
    EXPECT_EQ(outcome.exit_code, 1) << outcome.text;
    return outcome.text;
  };
  EXPECT_THAT(refused("file,when\n"), HasSubstr("flights.csv:1: the columns report and date (or day) are needed"));
  EXPECT_THAT(refused("report,date\nf01.json,15.3.2026\n"), HasSubstr("\"15.3.2026\" is no date; write 2026-03-31"));
  EXPECT_THAT(refused("report,date\nf01.json,2026-02-30\n"), HasSubstr("is no date"));
  EXPECT_THAT(refused("report,day,temperature_c\nf01.json,1,warm\n"),
              HasSubstr("temperature_c: \"warm\" is no number"));
  EXPECT_THAT(refused("report,day\nf01.json,1\n"), HasSubstr("fewer than two flights"));
  EXPECT_THAT(refused("report,day\nf01.json,1\nf02.json,2\n"), HasSubstr("f02.json"));
}

}  // namespace
