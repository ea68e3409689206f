#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/command.h"

// What the figure scripts share (tools/figures/lib.sh).
namespace {

namespace fs = std::filesystem;

std::string script(const std::string& name, const std::string& text) {
  // Tests of this file may run at the same time, each in a process of its own.
  const fs::path path =
      fs::path(testing::TempDir()) / ("figure_lines_" + name + "_" + std::to_string(::getpid()) + ".sh");
  std::ofstream(path) << ". '" << tests::source_path("tools/figures/lib.sh") << "'\n" << text << "\n";
  const std::string command = "bash '" + path.string() + "' 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return "popen failed";
  std::string out;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out += static_cast<char>(c);
  const int status = ::pclose(pipe);
  fs::remove(path);
  return out + "exit " + std::to_string(WEXITSTATUS(status));
}

std::string verdict(const std::string& condition) {
  const std::string text = script("verdict", "judge 1 measured bar what '" + condition + "'");
  return text.substr(0, text.find(" measured"));
}

TEST(FigureLines, AreOkWhereTheConditionHolds) {
  EXPECT_EQ(verdict("0.5 <= 1 && 2e-7 <= 1e-6"), "1 ok");
  EXPECT_EQ(verdict("\"pass\" == \"pass\" && 1 > 0"), "1 ok");
  EXPECT_EQ(verdict("1.5 <= 1"), "1 MISS");
}

TEST(FigureLines, MissWhereANumberIsNone) {
  for (const char* condition : {"nan <= 0.2", "-nan <= 0.2", "none <= 0.2", " <= 0.2", "0.1 <= 0.2 && inf >= 1", ""})
    EXPECT_EQ(verdict(condition), "1 MISS") << condition;
}

TEST(FigureLines, TakeFirstSeedAndFiguresInAnyOrder) {
  const std::string usage = "take_arguments 'x.sh [--quick] [--first-seed N] [FIGURE...]' ";
  const std::string show = "; all_or_named 1 2 3a; echo \"$first_seed ${figures[*]} quick=$quick\"";
  EXPECT_EQ(script("all", usage + show), "1001 1 2 3a quick=\nexit 0");
  EXPECT_EQ(script("some", usage + "3a --first-seed 7 --quick 1" + show), "7 3a 1 quick=yes\nexit 0");
}

TEST(FigureLines, RefuseFiguresAndSeedsThatAreNone) {
  for (const char* arguments : {"4", "--first-seed", "--first-seed 0", "--first-seed x", "--seed 3"}) {
    const std::string text =
        script("refused", std::string("take_arguments 'x.sh [--quick] [--first-seed N] [FIGURE...]' ") + arguments +
                              "; all_or_named 1 2 3a; echo went on");
    EXPECT_EQ(text.find("went on"), std::string::npos) << text;
    EXPECT_NE(text.find("exit 2"), std::string::npos) << text;
  }
}

}  // namespace
