#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <string>

#include "tests/support/command.h"

// `hovermodal identify` as a user runs it.
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::Outcome;

Outcome identify(const std::string& arguments) { return tests::run("hovermodal", "identify " + arguments); }

// Two modes, 1.5 Hz (1, 0.8, 0.5) and 4 Hz (-0.7, 0.3, 1), at `rate_hz`: displacements of three floors.
class Floors {
 public:
  explicit Floors(double rate_hz, unsigned seed = 1) : rate_hz_(rate_hz), random_(seed) {}

  struct Sample {
    double d[3];
  };
  Sample next() {
    for (int m = 0; m < 2; ++m) {
      const double w = 2.0 * std::numbers::pi * (m == 0 ? 1.5 : 4.0) / rate_hz_;
      const double r = std::exp(-0.01 * w);
      const double y = 2.0 * r * std::cos(w) * y_[m][0] - r * r * y_[m][1] + w * gaussian_(random_);
      y_[m][1] = y_[m][0];
      y_[m][0] = y;
    }
    Sample sample{};
    constexpr double kShape[3][2] = {{1.0, -0.7}, {0.8, 0.3}, {0.5, 1.0}};
    for (int c = 0; c < 3; ++c)
      sample.d[c] = kShape[c][0] * y_[0][0] + kShape[c][1] * y_[1][0] + 0.02 * gaussian_(random_);
    return sample;
  }

 private:
  double rate_hz_;
  std::mt19937_64 random_;
  std::normal_distribution<double> gaussian_;
  double y_[2][2] = {};
};

class Identify : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / "hovermodal_identify" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  // row(k, d): a line of the file, or nothing.
  [[nodiscard]] std::string floors(const std::string& name, const std::string& head,
                                   const std::function<std::string(int, const double*)>& row, int n = 6000,
                                   unsigned seed = 1) const {
    Floors source(20.0, seed);
    std::string text = head;
    for (int k = 0; k < n; ++k) text += row(k, source.next().d);
    return file(name, text);
  }
  static std::string three(int, const double* d) {
    char line[100];
    std::snprintf(line, sizeof line, "%.5f,%.5f,%.5f\n", d[0], d[1], d[2]);
    return line;
  }
  [[nodiscard]] nlohmann::json modal(const std::string& name = "out/modal.json") const {
    return nlohmann::json::parse(std::ifstream(folder_ / name));
  }
  [[nodiscard]] std::string out() const { return " --report " + (folder_ / "out").string(); }
  static nlohmann::json nearest(const nlohmann::json& json, double frequency_hz) {
    nlohmann::json best;
    for (const auto& mode : json.at("modes")) {
      const auto off = [&](const nlohmann::json& m) {
        return std::abs(m.at("frequency_hz").get<double>() - frequency_hz);
      };
      if (best.is_null() || off(mode) < off(best)) best = mode;
    }
    return best;
  }
  void expect_both_modes(const nlohmann::json& json) const {
    ASSERT_GE(json.at("modes").size(), 2U);
    EXPECT_NEAR(nearest(json, 1.5).at("frequency_hz").get<double>(), 1.5, 0.015);
    EXPECT_NEAR(nearest(json, 4.0).at("frequency_hz").get<double>(), 4.0, 0.03);
  }

  fs::path folder_;
};
TEST_F(Identify, HelpTeachesWithExamples) {
  const Outcome outcome = identify("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* word : {"--series", "--quantity", "--input ground", "--merge", "--delays-ms", "hovermodal identify"})
    EXPECT_THAT(outcome.text, HasSubstr(word));
}

TEST_F(Identify, ATableWithoutNamesNeedsOnlyItsRate) {
  const std::string path = floors("a.csv", "", three);
  for (const char* header : {"", " --no-header"}) {
    const Outcome outcome = identify("--series " + path + " --rate 20" + header + out());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
    EXPECT_THAT(outcome.text, AllOf(HasSubstr("c1"), HasSubstr("no line of names"), HasSubstr("no unit known")));
    expect_both_modes(modal());
    EXPECT_TRUE(fs::exists(folder_ / "out" / "report.html"));
  }
}

TEST_F(Identify, DecimalCommasAndColumnsByNumber) {
  const std::string path = floors("a.txt", "t [s];a [mm];b [mm];c [mm]\n", [](int k, const double* d) {
    char line[100];
    std::snprintf(line, sizeof line, "%.3f;%.5f;%.5f;%.5f\n", 0.05 * k, d[0], d[1], d[2]);
    for (char& c : line) c = c == '.' ? ',' : c;
    return std::string(line);
  });
  const Outcome outcome = identify("--series " + path + " --channels 2 c" + out());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  expect_both_modes(modal());
  EXPECT_TRUE(modal().at("modes")[0].at("shape").contains("a") && !modal().at("modes")[0].at("shape").contains("b"));
}

// Frames that a run lost are missing samples, not a shorter record.
TEST_F(Identify, LostFramesOfDisplacementsAreMasked) {
  const auto with_losses = [](bool with_times) {
    return [with_times](int k, const double* d) -> std::string {
      if (k % 50 < 12) return "";
      char line[120];
      std::snprintf(line, sizeof line, with_times ? "%d,%.6f,%.5f,%.5f,%.5f\n" : "%d,%.5f,%.5f,%.5f\n", k,
                    with_times ? 0.05 * k : d[0], with_times ? d[0] : d[1], with_times ? d[1] : d[2], d[2]);
      return line;
    };
  };
  const std::string times = floors("t.csv", "frame,t_s,a,b,c\n", with_losses(true));
  Outcome outcome = identify("--series " + times + " --quantity d" + out());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("of 5988 samples are missing"));
  expect_both_modes(modal());
  const std::string frames = floors("f.csv", "frame,a,b,c\n", with_losses(false));
  outcome = identify("--series " + frames + " --rate 20" + out());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("of 5988 samples are missing"));
  expect_both_modes(modal());
}

// A velocity beside displacements, by differences: only the right quantities make collinear shapes.
TEST_F(Identify, MixedQuantitiesAreDeclaredOrReadFromUnits) {
  double before = 0.0;
  const auto row = [&](int, const double* d) {
    char line[100];
    std::snprintf(line, sizeof line, "%.6f,%.6f,%.6f\n", d[0], d[1], (d[2] - before) * 20.0);
    before = d[2];
    return std::string(line);
  };
  const std::string units = floors("u.csv", "a [m],b [m],c [m/s]\n", row);
  before = 0.0;
  const std::string plain = floors("p.csv", "a,b,c\n", row);
  for (const std::string& arguments : {units, plain + " --quantity d,d,v"}) {
    const Outcome outcome = identify("--rate 20 --delays-ms 0,0,-25 --series " + arguments + out());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
    ASSERT_GE(modal().at("modes").size(), 1U) << outcome.text;
    const auto mode = modal().at("modes")[0];
    EXPECT_GT(mode.at("mpc").get<double>(), 0.99) << outcome.text;
    const auto shape = mode.at("shape");
    EXPECT_NEAR(shape.begin().value()[0].get<double>(), 1.0, 0.02);
    EXPECT_NEAR((--shape.end()).value()[0].get<double>(), 0.5, 0.03);
  }
}

TEST_F(Identify, SetupsAreMergedByTheirReferences) {
  const auto two = [](int moved) {
    return [moved](int, const double* d) {
      char line[100];
      std::snprintf(line, sizeof line, "%.5f,%.5f\n", d[moved], d[0]);
      return std::string(line);
    };
  };
  const std::string a = floors("a.csv", "moved [m/s^2],top [m/s^2]\n", two(1), 6000, 1);
  const std::string b = floors("b.csv", "moved [m/s^2],top [m/s^2]\n", two(2), 6000, 2);
  Outcome outcome = identify("--series " + a + " " + b + " --rate 20 --reference top --merge" + out());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  expect_both_modes(modal());
  const auto shape = nearest(modal(), 1.5).at("shape");
  EXPECT_NEAR(shape.at("a.moved")[0].get<double>(), 0.8, 0.03);
  EXPECT_NEAR(shape.at("b.moved")[0].get<double>(), 0.5, 0.03);
  EXPECT_TRUE(fs::exists(folder_ / "out" / "a" / "modal.json"));
  EXPECT_TRUE(fs::exists(folder_ / "out" / "b" / "report.html"));

  outcome = identify("--series " + a + " " + b + " --rate 20 --merge");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.text, HasSubstr("--merge needs --reference"));
  outcome = identify("--series " + a + " " + b + " --rate 20 --merge --reference roof");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("a.csv"), HasSubstr("'roof' is none of the channels")));
  outcome = identify("--series " + a + " --rate 20 --merge --reference top");
  EXPECT_EQ(outcome.exit_code, 2);
  // Without --merge each stands for itself.
  outcome = identify("--series " + a + " " + b + " --rate 20");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.text, Not(HasSubstr("merged")));
}

TEST_F(Identify, AMeasuredInputIsJudgedAndItsResponseListed) {
  const std::string path = floors("a.csv", "a,b,c,ground\n", [](int k, const double* d) {
    char line[120];
    std::snprintf(line, sizeof line, "%.5f,%.5f,%.5f,%.5f\n", d[0], d[1], d[2], std::sin(12.345 * k * k));
    return std::string(line);
  });
  const Outcome outcome = identify("--series " + path + " --rate 20 --quantity a --input ground" + out());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  expect_both_modes(modal());
  EXPECT_NEAR(modal().at("modes")[0].at("shape").at("ground")[0].get<double>(), 0.0, 0.1);
}

TEST_F(Identify, BadInputIsRefusedByNameOrStated) {
  const auto refused = [&](const std::string& text, const std::string& arguments, const char* why) {
    const Outcome outcome = identify("--series " + file("bad.csv", text) + " " + arguments);
    EXPECT_GT(outcome.exit_code, 0) << outcome.text;
    EXPECT_LE(outcome.exit_code, 2) << outcome.text;
    EXPECT_THAT(outcome.text, AllOf(HasSubstr("bad.csv"), HasSubstr(why)));
  };
  std::string rows;
  for (int k = 0; k < 1000; ++k)
    rows += std::to_string(std::sin(k * 0.7)) + "," + std::to_string(std::cos(k * k)) + "\n";
  refused("a,b\n" + rows, "", "say --rate-hz HZ");
  refused("a,b\n" + rows, "--rate 20 --channels z", "no column 'z'");
  refused("a,b\n" + rows, "--rate 20 --channels 7", "no column '7'");
  refused("a,b\n" + rows, "--rate 20 --quantity d,v,a", "3 quantities for 2 channels");
  refused("a,b\n" + rows, "--rate 20 --delays-ms 1,2,3", "3 delays for 2 channels");
  refused("a,b\n" + rows, "--rate 20 --input z", "no column 'z'");
  refused("a,b\n" + rows, "--rate 20 --segment 4096", "fewer than one segment of 4096");
  refused("a,b\n" + rows + "1\n", "--rate 20", "bad.csv:1002:");
  refused("a,b\n1,2\n3,4\n", "--rate 20", "fewer than one segment");
  refused("a,b\n1,2\n", "--rate 20", "fewer than two samples");
  refused("some words\nand more\n1,2\n", "--rate 20", "bad.csv:2:");
  refused("t_s,a\n0,1\n0.05,2\n0.1,3\n0.15,2\n", "--rate 50", "disagrees");
  refused("t_s,a\n0,1\n0.05,2\n0.1,3\n99999,2\n", "", "span");
  refused("frame,a\n0,1\n1.5,2\n3,1\n", "--rate 20", "frame: 1.5 is no number of a frame");
  refused("a,b\n1,1\n1,1\n1,1\n", "--rate 20", "no channel is left");
  EXPECT_EQ(identify("--series " + (folder_ / "none.csv").string() + " --rate 20").exit_code, 1);
  EXPECT_EQ(identify("--series x --rate -3").exit_code, 2);
  EXPECT_EQ(identify("").exit_code, 2);

  // Stated, not fatal.
  std::string with_holes = "a,b,c,d\n";
  for (int k = 0; k < 2000; ++k) {
    const std::string a = k % 100 == 7   ? "nan"
                          : k % 100 == 8 ? "inf"
                                         : std::to_string(std::sin(k * 0.7) + std::cos(k * k));
    const std::string b = std::to_string(1e9 * std::cos(k * 1.1 * k));
    with_holes += a + "," + b + ",5," + b + "\n";
  }
  const Outcome outcome = identify("--rate 20 --series " + file("holes.csv", with_holes) + out());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_THAT(outcome.text,
              AllOf(HasSubstr("20 infinite values"), HasSubstr("channel c is left out: it is constant (5)"),
                    HasSubstr("channel d is left out: it is a copy or a multiple of b"), Not(HasSubstr("nan"))));
}

TEST_F(Identify, AMillionLinesAreDoneWithProgress) {
  std::string text;
  text.reserve(8'000'000);
  Floors source(500.0);
  for (int k = 0; k < 1'000'000; ++k) {
    char line[16];
    std::snprintf(line, sizeof line, "%.4f\n", source.next().d[0]);
    text += line;
  }
  const Outcome outcome = identify("--rate 500 --max-frequency 8 --series " + file("long.csv", text));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("long.csv: 200000 lines read"), HasSubstr("1.5"), HasSubstr("2000.0 s")));
}

}  // namespace
