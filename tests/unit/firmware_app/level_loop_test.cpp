#include "firmware_app/replay/level_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/storage/structure_file.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/replay/run_folder.h"
#include "firmware_app/report/loop_report.h"

namespace app {
namespace {

using core::closure::LoopLevel;
using core::closure::LoopResult;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kRate_hz = 25.0, kFirst_hz = 1.9, kSecond_hz = 5.2;
constexpr int kFine = 40, kSamples = 3000;

struct Made {
  int drop_every = 0;     // lost frames that are not counted
  double jitter_s = 0.0;  // of the frames' times, which are stated
};

// displacements.csv of two floors, modes at 1.9 and 5.2 Hz, and of a static base.
std::string folder_with(const std::string& name, const Made& what) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / ("level_loop_" + name);
  std::filesystem::create_directories(folder);
  std::mt19937 engine(11);
  std::normal_distribution<double> draw;
  constexpr double kHz[2] = {kFirst_hz, kSecond_hz}, kShape[2][2] = {{0.6, 1.0}, {1.0, -0.6}};
  double x[2] = {}, v[2] = {};
  std::vector<double> floor[2];
  for (int k = 0; k < (kSamples + 2) * kFine; ++k) {
    const double h = 1.0 / (kRate_hz * kFine);
    double seen[2] = {};
    for (int m = 0; m < 2; ++m) {
      const double w = 2.0 * std::numbers::pi * kHz[m];
      v[m] += h * (-2.0 * 0.01 * w * v[m] - w * w * x[m]) + std::sqrt(h) * 5.0 * draw(engine);
      x[m] += h * v[m];
      for (int c = 0; c < 2; ++c) seen[c] += kShape[m][c] * x[m];
    }
    for (int c = 0; c < 2; ++c) floor[c].push_back(seen[c]);
  }
  std::ofstream out(folder / "displacements.csv");
  out.precision(9);
  out << "# hovermodal displacements, version 1\n# unit: mm\n# rate_hz: 25\nframe,t_s,scale_mm_per_px,base,low,high\n";
  int row = 0;
  for (int k = 1; k <= kSamples; ++k) {
    if (what.drop_every > 0 && k % what.drop_every == 0) continue;
    const double late = what.jitter_s * draw(engine);
    const auto at = static_cast<std::size_t>(std::max(0.0, k * kFine + std::round(late * kRate_hz * kFine)));
    const double t_s = what.jitter_s > 0.0 ? static_cast<double>(at) / (kRate_hz * kFine) : row / kRate_hz;
    out << row++ << ',' << t_s << ",0.9," << 0.002 * draw(engine);
    for (int c = 0; c < 2; ++c) out << ',' << floor[c][at] + 0.002 * draw(engine);
    out << '\n';
  }
  return folder.string();
}

LoopResult close(const std::string& folder, std::vector<double> reference_hz = {}) {
  LevelLoopInputs inputs;
  inputs.folder = folder;
  inputs.bases = {"base"};
  inputs.reference_hz = std::move(reference_hz);
  inputs.n_surrogates = 16;
  return close_levels(inputs);
}

const LoopLevel& level(const LoopResult& result, const char* name) {
  for (const LoopLevel& one : result.levels) {
    if (one.level == name) return one;
  }
  throw std::out_of_range(name);
}

TEST(LevelLoop, GoesThroughTheLevelsAndSaysWhatEachLacks) {
  const LoopResult result = close(folder_with("plain", {}));
  ASSERT_EQ(result.levels.size(), 4U);
  EXPECT_THAT(level(result, "observation").skipped, HasSubstr("--config"));
  EXPECT_THAT(level(result, "structure").skipped, HasSubstr("--structure"));
  EXPECT_EQ(level(result, "response").skipped, "");
  EXPECT_TRUE(level(result, "response").findings.empty());
  ASSERT_EQ(result.modes.size(), 2U);
  for (const auto& mode : result.modes) {
    ASSERT_TRUE(mode.before && mode.after);
    EXPECT_DOUBLE_EQ(mode.before->frequency_hz, mode.after->frequency_hz) << "nothing was repaired";
    EXPECT_TRUE(mode.after->halves_percent.has_value()) << "without a reference the halves are compared";
  }
}

TEST(LevelLoop, UncountedDropsAreRepairedAndTheModesComeNearerToTheReference) {
  const LoopResult result = close(folder_with("drops", {.drop_every = 50}), {kFirst_hz, kSecond_hz});
  const LoopLevel& response = level(result, "response");
  ASSERT_FALSE(response.findings.empty());
  EXPECT_THAT(response.findings.front().effect, HasSubstr("dropped_frames"));
  EXPECT_THAT(response.findings.front().repair, HasSubstr("gaps"));
  EXPECT_LT(*response.residual_after, *response.residual_before);
  EXPECT_TRUE(result.has_reference);
  ASSERT_TRUE(result.error_before && result.error_after);
  EXPECT_GT(*result.error_before, 1.5) << "two frames in a hundred";
  EXPECT_LT(*result.error_after, 0.7);
}

TEST(LevelLoop, OfALongRecordTheEndIsGoneThroughAndSaidSo) {
  LevelLoopInputs inputs;
  inputs.folder = folder_with("long", {});
  inputs.bases = {"base"};
  inputs.n_surrogates = 16;
  inputs.most_cells = 3 * 2000;
  const LoopResult result = close_levels(inputs);
  EXPECT_THAT(level(result, "clock and frames").left, HasSubstr("the last 80 s of 120 s"));
  EXPECT_EQ(result.modes.size(), 2U);
  inputs.most_cells = 3 * kSamples;
  EXPECT_THAT(level(close_levels(inputs), "clock and frames").left, Not(HasSubstr("the last")));
}

TEST(LevelLoop, MeasuredTimesAreUsedAndLeaveNoClockEffect) {
  const std::string folder = folder_with("jitter", {.jitter_s = 4e-3});
  const LoopResult result = close(folder, {kFirst_hz, kSecond_hz});
  const LoopLevel& clock = level(result, "clock and frames");
  EXPECT_NEAR(*clock.residual_before, 4.0, 0.5);
  EXPECT_DOUBLE_EQ(*clock.residual_after, 0.0);
  EXPECT_THAT(clock.findings.front().repair, HasSubstr("interpolated"));
  EXPECT_TRUE(level(result, "response").findings.empty()) << level(result, "response").findings.front().effect;
}

TEST(LevelLoop, TheReportHoldsTheTablesAsTextJsonAndPage) {
  const std::string folder = folder_with("report", {.drop_every = 50});
  const LoopResult result = close(folder, {kFirst_hz, kSecond_hz});
  write_loop_report(folder, result);
  const auto json = nlohmann::json::parse(drivers::read_text_file(folder + "/loop.json", 1 << 20));
  EXPECT_EQ(json["levels"].size(), 4U);
  EXPECT_EQ(json["compared_with"], "reference");
  EXPECT_EQ(json["levels"][2]["closure"]["level"], "response");
  EXPECT_NEAR(json["modes"][0]["reference_hz"].get<double>(), kFirst_hz, 1e-9);
  const std::string page = drivers::read_text_file(folder + "/loop.html", 1 << 20);
  EXPECT_THAT(page, HasSubstr("plot wide"));
  EXPECT_THAT(page, HasSubstr("viewBox=\"0 0 328 ")) << "for a phone";
  EXPECT_THAT(page, HasSubstr("dropped_frames"));
  EXPECT_THAT(loop_text(result), HasSubstr("no structure is declared"));
  EXPECT_EQ(page.find("id=\"structure\""), std::string::npos);
}

TEST(LevelLoop, TheReportDrawsADeclaredStructureBesideTheModes) {
  LevelLoopInputs inputs;
  inputs.folder = folder_with("structure", {});
  inputs.bases = {"base"};
  inputs.n_surrogates = 16;
  // A string whose first and third modes are near those of the record.
  inputs.structure = drivers::parse_structure(
      "structure: {kind: cable, length_m: 100, mass_per_m_kg: 1, tension_n: 129600, tension_prior_percent: 30}\n",
      "cable.yaml");
  const LoopResult result = close_levels(inputs);
  ASSERT_EQ(level(result, "structure").skipped, "");
  const std::string page = loop_page(result);
  const std::size_t section = page.find("id=\"structure\"");
  ASSERT_NE(section, std::string::npos);
  EXPECT_NE(page.find("<svg", section), std::string::npos);
  ASSERT_FALSE(level(result, "structure").pictures.empty());
  EXPECT_NE(page.find(level(result, "structure").pictures.front().svg, section), std::string::npos);
}

TEST(LevelLoop, AFolderWithoutARecordIsRefusedInWords) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "level_loop_empty";
  std::filesystem::create_directories(folder);
  EXPECT_THROW((void)close(folder.string()), drivers::FileError);
}

}  // namespace
}  // namespace app
