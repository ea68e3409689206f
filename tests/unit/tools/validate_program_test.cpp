#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/command.h"

// `hovermodal-validate` as a user runs it.
namespace {

std::string validate(const std::string& what) {
  const tests::Outcome outcome = tests::run("hovermodal-validate", what);
  return outcome.exit_code == 0 ? outcome.text : std::string();
}

TEST(Validate, FindsEveryEffectWhereItsSignatureSaysItIs) {
  std::istringstream lines(validate("signatures"));
  int n_effects = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("signature\t", 0) != 0) continue;
    std::istringstream cells(line);
    std::string word, effect, rms, error;
    std::getline(cells, word, '\t');
    std::getline(cells, effect, '\t');
    std::getline(cells, rms, '\t');
    std::getline(cells, error, '\t');
    EXPECT_GT(std::stod(rms), 1e-3) << effect;
    EXPECT_LT(std::stod(error), 1.0) << effect;
    ++n_effects;
  }
  EXPECT_EQ(n_effects, 31);
}

TEST(Validate, OpenCvFindsTheDrawnPointsWhereTheTracksAre) {
  std::istringstream lines(validate("klt --frames 3"));
  int n_scenes = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("klt\t", 0) != 0) continue;
    std::istringstream cells(line);
    std::string word, scene, worst, rms;
    std::getline(cells, word, '\t');
    std::getline(cells, scene, '\t');
    std::getline(cells, worst, '\t');
    std::getline(cells, rms, '\t');
    EXPECT_GT(std::stod(rms), 0.005) << scene;  // the frames are noisy
    EXPECT_LT(std::stod(rms), 0.05) << scene;
    ++n_scenes;
  }
  EXPECT_EQ(n_scenes, 3);
}

int count_lines(const std::string& text, const std::string& start) {
  std::istringstream lines(text);
  int n = 0;
  for (std::string line; std::getline(lines, line);) n += line.rfind(start, 0) == 0 ? 1 : 0;
  return n;
}

TEST(Validate, SaysTheSameOfTheIdentificationOnAnyNumberOfThreads) {
  const std::string text = validate("bias --seeds 3 --threads 1");
  EXPECT_EQ(text, validate("bias --seeds 3 --threads 3"));
  EXPECT_EQ(count_lines(text, "bias\tcorrected\t"), 6) << text;
  EXPECT_EQ(count_lines(text, "bias\tuncorrected\t"), 6) << text;
  EXPECT_EQ(count_lines(text, "bias-all\tcorrected\t3\t0\t"), 1) << "three records, no false mode\n" << text;
}

TEST(Validate, JudgesLossesAndRigidBuildings) {
  EXPECT_EQ(count_lines(validate("losses --seeds 1"), "losses\t"), 48);
  EXPECT_EQ(count_lines(validate("null --seeds 1"), "null\tfloors\t1\t0\t0\t"), 1) << "no mode in a rigid building";
}

TEST(Validate, ClosesTheLoopOnOtherRecordsFromAnotherFirstSeed) {
  for (const std::string what : {"closure --seeds 1", "closure-clip --duration 2",
                                 "closure-tracks --seeds 1 --duration 24 --effect 'camera roll' --strength 1"}) {
    const std::string text = validate(what + " --first-seed 1");
    EXPECT_GT(text.size(), 100U) << what;
    EXPECT_NE(text, validate(what + " --first-seed 2")) << what;
  }
}

// But for the seconds, which are the last cell of a line.
std::string without_seconds(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);) out += line.substr(0, line.rfind('\t')) + "\n";
  return out;
}

TEST(Validate, SaysTheSameOfForeignRecordsOnAnyNumberOfThreads) {
  const std::string null = "closure-tracks-foreign-null --seeds 2 --duration 24";
  const std::string text = without_seconds(validate(null + " --threads 1"));
  EXPECT_EQ(text, without_seconds(validate(null + " --threads 2")));
  EXPECT_EQ(count_lines(text, "closure-tracks-foreign-null\t"), 2) << text;
  const std::string with = "closure-tracks-foreign --seeds 1 --duration 24 --effect 'camera roll' --strength 5";
  EXPECT_EQ(count_lines(validate(with), "closure-tracks-foreign\tcamera roll\t5\t"), 1);
}

// The cells of every line that starts so.
std::vector<std::vector<std::string>> rows(const std::string& text, const std::string& start) {
  std::istringstream lines(text);
  std::vector<std::vector<std::string>> out;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(start, 0) != 0) continue;
    std::istringstream cells(line);
    out.emplace_back();
    for (std::string cell; std::getline(cells, cell, '\t');) out.back().push_back(cell);
  }
  return out;
}

TEST(Validate, SaysTheSameOfTheGeometryOnAnyNumberOfThreads) {
  const std::string text = validate("elevation --seeds 2 --duration 60 --threads 1");
  EXPECT_EQ(text, validate("elevation --seeds 2 --duration 60 --threads 2"));
  const auto scale = rows(text, "elevation\t30deg\tone-scale\t");
  ASSERT_EQ(scale.size(), 1U) << text;
  ASSERT_EQ(scale[0].size(), 22U) << text;
  EXPECT_EQ(scale[0][3], "2");
  EXPECT_EQ(scale[0][13], "6") << "true modes";
  EXPECT_LT(std::stod(scale[0][5]), 1.0) << "median error of the frequency, %";
  EXPECT_GT(std::stod(scale[0][9]), 0.9) << "median MAC";
}

// Nothing that looks at the noisy points of a frame is better than the bound, however the camera is known. (The paper's
// chain mixes in the frame before.)
TEST(Validate, NoNoiseFloorLiesBelowTheBound) {
  const auto channels = rows(validate("noise-floor --seeds 1 --duration 60"), "noise-floor\t");
  ASSERT_GE(channels.size(), 18U);
  for (const auto& cells : channels) {
    ASSERT_EQ(cells.size(), 14U);
    if (cells[1] == "paper") continue;
    const double white_px = std::stod(cells[7]), known_px = std::stod(cells[8]), estimated_px = std::stod(cells[10]);
    EXPECT_GT(white_px, 0.9 * known_px) << cells[1] << " " << cells[2];
    EXPECT_GE(estimated_px, known_px) << cells[1] << " " << cells[2];
  }
}

TEST(Validate, PlansTheDeckAsItIsFound) {
  const std::string text = validate("deck --seeds 1 --duration 120");
  EXPECT_EQ(count_lines(text, "deck\tlandscape\tours\t"), 1) << text;
  int n_folded = 0;
  for (const auto& cells : rows(text, "deck-mode\t")) {
    ASSERT_EQ(cells.size(), 9U);
    if (cells[2] != "ours" || std::stod(cells[3]) < 15.0) continue;
    ++n_folded;
    EXPECT_EQ(cells[4] == "resolved", cells[1] == "turned") << "as planned for " << cells[3];
    EXPECT_EQ(cells[8], "0") << "certain and wrong: " << cells[1] << " " << cells[3];
  }
  EXPECT_EQ(n_folded, 4) << text;
}

// Drawn points are of unequal noise, which the bound knows.
TEST(Validate, NoDrawnNoiseFloorLiesBelowTheBound) {
  const auto ways = rows(validate("noise-floor-drawn --seeds 2 --duration 60"), "noise-floor-drawn\t");
  ASSERT_EQ(ways.size(), 4U);
  for (const auto& cells : ways) {
    ASSERT_EQ(cells.size(), 14U);
    if (cells[1] == "paper") continue;
    EXPECT_GT(std::stod(cells[7]), 0.9 * std::stod(cells[8])) << cells[1];
    EXPECT_GE(std::stod(cells[10]), std::stod(cells[8])) << cells[1];
  }
}

TEST(Validate, AnotherFirstSeedGivesOtherNumbers) {
  for (const std::string check : {"signatures", "pixels", "klt --frames 1", "peaks --seeds 1", "null --seeds 1",
                                  "elevation --seeds 1 --duration 60", "elevation-drawn --seeds 1 --duration 60"}) {
    const std::string first = validate(check + " --first-seed 1"), second = validate(check + " --first-seed 2");
    ASSERT_FALSE(first.empty() || second.empty()) << check;
    EXPECT_EQ(first, validate(check)) << check;
    EXPECT_NE(first, second) << check;
  }
}

TEST(Validate, RefusesWhatACheckHasNoUseFor) {
  for (const auto& [arguments, option] :
       {std::pair{"shifts --seeds 3", "--seeds"}, std::pair{"peaks --threads 2", "--threads"},
        std::pair{"bias --flight f.csv", "--flight"}, std::pair{"null --duration 60", "--duration"},
        std::pair{"wind --frames 3", "--frames"}}) {
    const tests::Outcome outcome = tests::run("hovermodal-validate", arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.text.find(option), std::string::npos) << outcome.text;
  }
}

}  // namespace
