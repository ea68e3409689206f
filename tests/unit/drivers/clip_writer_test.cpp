#include "drivers/storage/clip_writer.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace drivers {
namespace {

namespace fs = std::filesystem;
constexpr int kWidth = 320, kHeight = 180;

class ClipWriterTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / "hovermodal_clip_writer" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }
  [[nodiscard]] bool folder_is_empty() const { return fs::is_empty(folder_); }

  fs::path folder_;
};

// Bars of every grey level from black to white, moved by `shift` px.
std::vector<std::uint8_t> bars(int shift) {
  std::vector<std::uint8_t> pixels;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      pixels.push_back(static_cast<std::uint8_t>(std::clamp((u + v + shift) * 255 / (kWidth + kHeight), 0, 255)));
    }
  }
  return pixels;
}

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const std::exception& e) {
    return e.what();
  }
  return {};
}

TEST_F(ClipWriterTest, GivesBackTheGreyLevels) {
  const std::string clip = path("clip.mp4");
  ClipWriter writer(clip, kWidth, kHeight, 25.0, 0);
  for (int k = 0; k < 10; ++k) writer.write(bars(3 * k).data());
  writer.finish();

  cv::VideoCapture capture(clip);
  ASSERT_TRUE(capture.isOpened());
  EXPECT_NEAR(capture.get(cv::CAP_PROP_FPS), 25.0, 1e-6);
  EXPECT_EQ(capture.get(cv::CAP_PROP_FRAME_COUNT), 10.0);
  cv::Mat colour, grey;
  for (int k = 0; k < 10; ++k) {
    ASSERT_TRUE(capture.read(colour));
    cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
    const auto expected = bars(3 * k);
    int worst = 0;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      worst = std::max(worst, std::abs(int{grey.data[i]} - int{expected[static_cast<std::size_t>(i)]}));
    }
    EXPECT_LE(worst, 1) << "frame " << k;
  }
  EXPECT_FALSE(capture.read(colour));
  EXPECT_FALSE(fs::exists(clip + ".partial"));
}

TEST_F(ClipWriterTest, LeavesNothingWhenAbandoned) {
  {
    ClipWriter writer(path("clip.mp4"), kWidth, kHeight, 25.0, 20);
    writer.write(bars(0).data());
  }
  EXPECT_TRUE(folder_is_empty());
}

TEST_F(ClipWriterTest, TellsWhichProgramIsMissing) {
  const std::string search_path = std::getenv("PATH");
  ::setenv("PATH", "/nonexistent", 1);
  // A missing program shows at the start or, as on emulated processors, in the child's exit code.
  const std::string message = message_of([&] {
    ClipWriter writer(path("clip.mp4"), kWidth, kHeight, 25.0, 20);
    for (int i = 0; i < 100; ++i) writer.write(bars(i).data());
    writer.finish();
  });
  ::setenv("PATH", search_path.c_str(), 1);
  EXPECT_NE(message.find("apt-get install ffmpeg"), std::string::npos) << message;
}

TEST_F(ClipWriterTest, PassesOnWhyTheFileCannotBeWritten) {
  const std::string message = message_of([&] {
    ClipWriter writer(path("no/such/folder/clip.mp4"), kWidth, kHeight, 25.0, 20);
    for (int k = 0; k < 100; ++k) writer.write(bars(k).data());
    writer.finish();
  });
  EXPECT_NE(message.find("No such file or directory"), std::string::npos) << message;
}

// The encoder inherits a limit on file sizes and ends by it, as on a full disk; further writing must not raise SIGPIPE.
TEST_F(ClipWriterTest, SurvivesTheEncodersDeath) {
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  rlimit small = old;
  small.rlim_cur = 4096;
  std::string message;
  {
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    message = message_of([&] {
      ClipWriter writer(path("clip.mp4"), kWidth, kHeight, 25.0, 0);
      std::vector<std::uint8_t> noise(kWidth * kHeight);
      for (int k = 0; k < 400; ++k) {
        for (auto& pixel : noise) pixel = static_cast<std::uint8_t>(std::rand());
        writer.write(noise.data());
      }
      writer.finish();
    });
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
  }
  EXPECT_NE(message.find("clip.mp4"), std::string::npos) << message;
  EXPECT_TRUE(folder_is_empty());
}

TEST_F(ClipWriterTest, RefusesWhatCannotBeEncoded) {
  EXPECT_THROW(ClipWriter(path("a.mp4"), 321, 180, 25.0, 20), std::invalid_argument);
  EXPECT_THROW(ClipWriter(path("a.mp4"), 0, 180, 25.0, 20), std::invalid_argument);
  EXPECT_THROW(ClipWriter(path("a.mp4"), 320, 180, 0.0, 20), std::invalid_argument);
  EXPECT_THROW(ClipWriter(path("a.mp4"), 320, 180, std::nan(""), 20), std::invalid_argument);
  EXPECT_THROW(ClipWriter(path("a.mp4"), 320, 180, 25.0, 60), std::invalid_argument);
  EXPECT_TRUE(folder_is_empty());
}

}  // namespace
}  // namespace drivers
