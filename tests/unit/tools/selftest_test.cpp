#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/support/command.h"

// `hovermodal selftest` as a user runs it.
namespace {

std::string selftest(const std::string& what) {
  const tests::Outcome outcome = tests::run("hovermodal", "selftest " + what);
  return outcome.exit_code == 0 ? outcome.text : std::string();
}

TEST(Selftest, FindsEveryEffectWhereItsSignatureSaysItIs) {
  std::istringstream lines(selftest("signatures"));
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
  EXPECT_EQ(n_effects, 20);
}

TEST(Selftest, OpenCvFindsTheDrawnPointsWhereTheTracksAre) {
  std::istringstream lines(selftest("klt --frames 3"));
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

TEST(Selftest, SaysTheSameOfTheIdentificationOnAnyNumberOfThreads) {
  const std::string text = selftest("bias --seeds 3 --threads 1");
  EXPECT_EQ(text, selftest("bias --seeds 3 --threads 3"));
  EXPECT_EQ(count_lines(text, "bias\tcorrected\t"), 6) << text;
  EXPECT_EQ(count_lines(text, "bias\tuncorrected\t"), 6) << text;
  EXPECT_EQ(count_lines(text, "bias-all\tcorrected\t3\t0\t"), 1) << "three records, no false mode\n" << text;
}

TEST(Selftest, JudgesLossesAndRigidBuildings) {
  EXPECT_EQ(count_lines(selftest("losses --seeds 1"), "losses\t"), 48);
  EXPECT_EQ(count_lines(selftest("null --seeds 1"), "null\tfloors\t1\t0\t0\t"), 1) << "no mode in a rigid building";
}

}  // namespace
