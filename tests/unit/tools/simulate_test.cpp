#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <string>

#include "firmware_app/config/config.h"
#include "tests/support/command.h"

// `hovermodal simulate` as a user runs it.
namespace {

namespace fs = std::filesystem;

using tests::Outcome;
using tests::read;

Outcome simulate(const std::string& arguments) { return tests::run("hovermodal", "simulate " + arguments); }

class Simulate : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / "hovermodal_simulate" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string out() const { return " --out " + (folder_ / "out").string(); }

  fs::path folder_;
};

TEST_F(Simulate, WritesAClipWithItsTruthAndConfiguration) {
  const Outcome outcome = simulate("--size 320x180 --duration 2 --seed 4 --method paper" + out());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  const fs::path made = folder_ / "out";

  cv::VideoCapture capture((made / "clip.mp4").string());
  ASSERT_TRUE(capture.isOpened());
  EXPECT_EQ(capture.get(cv::CAP_PROP_FRAME_COUNT), 50.0);
  EXPECT_EQ(capture.get(cv::CAP_PROP_FRAME_WIDTH), 320.0);

  const auto truth = nlohmann::json::parse(read(made / "truth.json"));
  ASSERT_EQ(truth.at("modes").size(), 6U);
  EXPECT_DOUBLE_EQ(truth.at("modes")[0].at("frequency_hz").get<double>(), 1.657);
  EXPECT_DOUBLE_EQ(truth.at("modes")[0].at("shape").at("floor6").get<double>(), 1.0);
  EXPECT_EQ(truth.at("scene").at("seed").get<int>(), 4);

  const app::AppConfig config = app::load_config((made / "config.yaml").string());
  EXPECT_EQ(config.method, app::Method::kPaper);
  EXPECT_EQ(fs::path(config.camera.source), fs::absolute(made / "clip.mp4"));
  EXPECT_DOUBLE_EQ(config.camera.readout_ms, 26.0);
  EXPECT_DOUBLE_EQ(config.scale.known_length_mm, 840.0);
  EXPECT_EQ(config.regions.size(), 8U);
}

TEST_F(Simulate, WritesTheSamePixelsUncompressedAndWithoutLoss) {
  const std::string scene = "--size 320x180 --duration 1 --seed 4 --out ";
  ASSERT_EQ(simulate("--raw " + scene + (folder_ / "raw").string()).exit_code, 0);
  ASSERT_EQ(simulate("--crf 0 " + scene + (folder_ / "h264").string()).exit_code, 0);
  EXPECT_EQ(fs::path(app::load_config((folder_ / "raw" / "config.yaml").string()).camera.source),
            fs::absolute(folder_ / "raw" / "clip.y4m"));
  EXPECT_FALSE(fs::exists(folder_ / "raw" / "clip.mp4"));

  cv::VideoCapture raw((folder_ / "raw" / "clip.y4m").string()), h264((folder_ / "h264" / "clip.mp4").string());
  ASSERT_TRUE(raw.isOpened() && h264.isOpened());
  EXPECT_EQ(raw.get(cv::CAP_PROP_FPS), 25.0);
  int n = 0;
  for (cv::Mat a, b; raw.read(a) && h264.read(b); ++n) EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0.0) << "frame " << n;
  EXPECT_EQ(n, 25);
}

TEST_F(Simulate, WritesTracksAndTrueDisplacementsFrameByFrame) {
  const Outcome outcome = simulate("--tracks-only --duration 2 --points 5 --track-noise-px 0" + out());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_FALSE(fs::exists(folder_ / "out" / "clip.mp4"));
  std::istringstream tracks(read(folder_ / "out" / "tracks.csv"));
  std::string line, last;
  int n = 0;
  bool heading = false;
  while (std::getline(tracks, line)) {
    if (line.starts_with("#")) continue;
    if (!heading) {
      EXPECT_EQ(line, "frame,t_s,point,region,u_px,v_px,sigma_px");
      heading = true;
    } else {
      last = line;
      ++n;
    }
  }
  EXPECT_EQ(n, 50 * 5 * 8);
  EXPECT_TRUE(last.starts_with("49,1.960000000,39,background,"));

  std::istringstream truth(read(folder_ / "out" / "truth_displacements.csv"));
  n = 0;
  while (std::getline(truth, line)) n += line.starts_with("#") ? 0 : 1;
  EXPECT_EQ(n, 51);
}

TEST_F(Simulate, IsAFunctionOfItsSeed) {
  for (const char* name : {"a", "b", "c"}) {
    const std::string seed = std::string(name) == "c" ? "9" : "8";
    ASSERT_EQ(simulate("--tracks-only --duration 2 --seed " + seed + " --out " + (folder_ / name).string()).exit_code,
              0);
  }
  EXPECT_EQ(read(folder_ / "a" / "tracks.csv"), read(folder_ / "b" / "tracks.csv"));
  EXPECT_NE(read(folder_ / "a" / "tracks.csv"), read(folder_ / "c" / "tracks.csv"));
}

TEST_F(Simulate, ReusesWhatItHasAlreadyMade) {
  ASSERT_EQ(simulate("--tracks-only --duration 2" + out()).exit_code, 0);
  const auto made_at = fs::last_write_time(folder_ / "out" / "tracks.csv");
  const Outcome again = simulate("--tracks-only --duration 2 --method paper" + out());
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.text.find("already made"), std::string::npos) << again.text;
  EXPECT_EQ(fs::last_write_time(folder_ / "out" / "tracks.csv"), made_at);
  EXPECT_NE(read(folder_ / "out" / "config.yaml").find("method: paper"), std::string::npos);

  EXPECT_EQ(simulate("--tracks-only --duration 2 --seed 2" + out()).text.find("already made"), std::string::npos);
  EXPECT_EQ(simulate("--tracks-only --duration 2 --seed 2 --force" + out()).text.find("already made"),
            std::string::npos);
  std::ofstream(folder_ / "out" / "tracks.csv") << "cut short";
  EXPECT_EQ(simulate("--tracks-only --duration 2 --seed 2" + out()).text.find("already made"), std::string::npos);
}

TEST_F(Simulate, RefusesBadUsageWithExitCode2) {
  for (const char* arguments : {"--duration 0", "--duration nan", "--duration -5", "--duration inf", "--duration 0.001",
                                "--size 64x64", "--size 321x181", "--size big", "--size x", "--size 99999x99999",
                                "--crf 70", "--preset other", "--method other", "--seed -1", "--threads -2",
                                "--tracks-only --track-noise-px nan", "--tracks-only --points 0"}) {
    const Outcome outcome = simulate(std::string(arguments) + out());
    EXPECT_EQ(outcome.exit_code, 2) << arguments << ": " << outcome.text;
    EXPECT_FALSE(outcome.text.empty());
  }
  EXPECT_EQ(simulate("--duration 2").exit_code, 2);  // nowhere to write
}

TEST_F(Simulate, RefusesAFolderThatIsAFileOrCannotBeMade) {
  std::ofstream(folder_ / "file") << "x";
  const Outcome file = simulate("--tracks-only --duration 2 --out " + (folder_ / "file").string());
  EXPECT_EQ(file.exit_code, 2);
  EXPECT_NE(file.text.find("is a file"), std::string::npos) << file.text;
  EXPECT_NE(simulate("--tracks-only --duration 2 --out /proc/hovermodal").exit_code, 0);
}

}  // namespace
