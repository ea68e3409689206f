#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>
#include <string>

// `hovermodal selftest` as a user runs it.
namespace {

std::string selftest(const std::string& what) {
  const std::string command = std::string(HOVERMODAL_BIN_DIR) + "/hovermodal selftest " + what;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  char block[4096];
  while (const std::size_t n = std::fread(block, 1, sizeof block, pipe)) text.append(block, n);
  return ::pclose(pipe) == 0 ? text : std::string();
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

}  // namespace
