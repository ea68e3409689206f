// hovermodal batch on small simulated flights, as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/answers.h"
#include "tests/support/command.h"
#include "tests/support/folder_test.h"

namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// Three flights of one view, one of another (a smaller picture of the same), one that is damaged.
class Batch : public tests::FolderTest {
 protected:
  void make_flights() const {
    for (int seed = 1; seed <= 4; ++seed) {
      const std::string size = seed == 4 ? " --size 720p" : "";
      const auto made = tests::run(
          "hovermodal", "simulate --preset paper --tracks-only --points 6 --duration 60 --seed " +
                            std::to_string(seed) + size + " --out " + (folder_ / "in" / std::to_string(seed)).string());
      ASSERT_EQ(made.exit_code, 0) << made.text;
    }
    fs::create_directories(folder_ / "in" / "5");
    std::ofstream(folder_ / "in" / "5" / "tracks.csv") << "this is no file of tracks\n";
    fs::copy_file(folder_ / "in" / "1" / "config.yaml", folder_ / "in" / "5" / "config.yaml");
    // The same flight once more under another name: it must not count twice.
    fs::copy(folder_ / "in" / "2", folder_ / "in" / "2_again");
  }

  [[nodiscard]] tests::Outcome batch(const std::string& out, const std::string& more) const {
    return tests::run("hovermodal", "batch " + (folder_ / "in").string() + " --out " + (folder_ / out).string() +
                                        " --set spectrum.segment=256 " + more);
  }
  [[nodiscard]] nlohmann::json result(const std::string& out) const {
    return nlohmann::json::parse(tests::read(folder_ / out / "batch.json"));
  }
};

TEST_F(Batch, PrintsItsResultAsJsonOrNothing) {
  for (const char* seed : {"1", "2"}) {
    const auto made =
        tests::run("hovermodal", std::string("simulate --preset paper --tracks-only --points 6 --duration 60 "
                                             "--seed ") +
                                     seed + " --out " + (folder_ / "in" / seed).string());
    ASSERT_EQ(made.exit_code, 0) << made.text;
  }
  const nlohmann::json told = tests::expect_answers("batch " + (folder_ / "in").string() + " --out " +
                                                    (folder_ / "out").string() + " --set spectrum.segment=256");
  EXPECT_EQ(told, result("out"));
  EXPECT_EQ(told["flights"].size(), 2U);
}

TEST_F(Batch, GivesTheSameBytesForAnyNumberOfProcesses) {
  ASSERT_NO_FATAL_FAILURE(make_flights());
  const auto one = batch("one", "--jobs 1"), two = batch("two", "--jobs 2");
  ASSERT_EQ(one.exit_code, 1) << one.text;  // a flight failed
  ASSERT_EQ(two.exit_code, 1) << two.text;
  for (const char* file : {"batch.json", "batch.txt", "batch.svg", "views/1/modal.json", "flights/3/modal.json"})
    EXPECT_EQ(tests::read(folder_ / "one" / file), tests::read(folder_ / "two" / file)) << file;

  EXPECT_THAT(one.text, HasSubstr("5: failed: "));
  EXPECT_THAT(one.text, HasSubstr("2_again: has the same samples as 2: counted once"));
  const nlohmann::json json = result("one");
  ASSERT_EQ(json["views"].size(), 2U);
  EXPECT_EQ(json["views"][0]["flights"], nlohmann::json({"1", "2", "3"}));
  EXPECT_EQ(json["views"][1]["flights"], nlohmann::json({"4"}));
  EXPECT_THAT(json["flights"][5]["failure"].get<std::string>(), StartsWith("5/tracks.csv:1: "));
  ASSERT_GE(json["modes"].size(), 3U);
  const nlohmann::json& first = json["modes"][0];
  EXPECT_NEAR(first["frequency_hz"]["value"].get<double>(), 1.65, 0.05);
  EXPECT_EQ(first["flights"], 4);
  EXPECT_EQ(first["by_view"].size(), 2U);
  double weights = 0.0, sum = 0.0;
  for (const auto& view : first["by_view"]) {
    const double weight = std::pow(view["frequency_std_hz"].get<double>(), -2.0);
    weights += weight, sum += weight * view["frequency_hz"].get<double>();
  }
  EXPECT_NEAR(first["frequency_hz"]["value"].get<double>(), sum / weights, 1e-9);
  EXPECT_GT(first["frequency_hz"]["std"].get<double>(), 1.0 / std::sqrt(weights));  // these are estimates, too
  EXPECT_TRUE(fs::exists(folder_ / "one" / "flights" / "1" / "report.html"));
  EXPECT_FALSE(fs::exists(folder_ / "one" / "flights" / "1" / "flight.sums"));
}

// The configuration declares a lens that does not exist: it also decides whether the error is corrected in flight.
TEST_F(Batch, AClipAdoptsEffectsWhereItsConfigurationSaysSo) {
  const std::string clip = (folder_ / "in" / "a").string();
  const auto made = tests::run("hovermodal", "simulate --preset paper --size 270p --duration 60 --out " + clip);
  ASSERT_EQ(made.exit_code, 0) << made.text;
  const std::string closure =
      "--set closure.period_s=20 --set closure.window_s=24 --set closure.delay_s=4 --set closure.points_per_region=5 "
      "--set \"calibration.distortion=[0.2, 0, 0, 0]\" --set closure.adopt=";
  for (const std::string adopt : {"auto", "report"}) {
    const auto outcome = batch(adopt, closure + adopt);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
    const std::string log = tests::read(folder_ / adopt / "flights" / "a" / "clip" / "log.txt");
    EXPECT_EQ(log.find("from frame 1100 on taken out, radial distortion") != std::string::npos, adopt == "auto") << log;
  }
}

TEST_F(Batch, AFolderWithoutFlightsIsAUsageError) {
  fs::create_directories(folder_ / "empty");
  const auto outcome =
      tests::run("hovermodal", "batch " + (folder_ / "empty").string() + " --out " + (folder_ / "nothing").string());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("no flight in it"));
}

TEST_F(Batch, SeveralStartedTogetherWithoutMpiAreRefused) {
  fs::create_directories(folder_ / "in");
  ::setenv("OMPI_COMM_WORLD_SIZE", "2", 1);
  const auto refused = batch("refused", "--jobs 1");
  ::unsetenv("OMPI_COMM_WORLD_SIZE");
  EXPECT_EQ(refused.exit_code, 2) << refused.text;
  EXPECT_THAT(refused.text, HasSubstr("give --mpi"));
}

}  // namespace
