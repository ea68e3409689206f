#include "firmware_app/service/kept_keyframe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

namespace app {
namespace {

using ::testing::HasSubstr;
constexpr std::uint64_t kHash = 7;

core::CameraInfo camera() {
  core::CameraInfo info;
  info.width_px = 8;
  info.height_px = 6;
  return info;
}

KeptKeyframe sample() {
  KeptKeyframe kept;
  kept.image.width_px = 8;
  kept.image.height_px = 6;
  for (std::uint8_t i = 0; i < 48; ++i) kept.image.pixels.push_back(i);
  kept.points.points.resize(3);
  kept.points.points[1].u_px = 2.25;
  kept.points.points[2].region = 1;
  return kept;
}

class KeptKeyframeFile : public ::testing::Test {
 protected:
  KeptKeyframeFile() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    const auto folder = std::filesystem::path(::testing::TempDir()) / "kept_keyframe" / test->name();
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    path = (folder / "hovermodal.keyframe").string();
  }
  KeyframeRead written_and_read(const std::function<void(KeptKeyframe&)>& change) const {
    KeptKeyframe kept = sample();
    change(kept);
    EXPECT_EQ(write_keyframe(path, kHash, kept.image, kept.points), "");
    return read_keyframe(path, kHash, camera(), 2);
  }

  std::string path;
};

TEST_F(KeptKeyframeFile, ReadsBackWhatWasWritten) {
  const KeyframeRead read = written_and_read([](KeptKeyframe&) {});
  ASSERT_TRUE(read.keyframe) << read.refused;
  EXPECT_EQ(read.keyframe->image.pixels, sample().image.pixels);
  ASSERT_EQ(read.keyframe->points.points.size(), 3U);
  EXPECT_EQ(read.keyframe->points.points[1].u_px, 2.25);
  EXPECT_EQ(read.keyframe->points.points[2].region, 1);
}

TEST_F(KeptKeyframeFile, NoFileIsNoKeyframeAndNoFault) {
  const KeyframeRead read = read_keyframe(path, kHash, camera(), 2);
  EXPECT_FALSE(read.keyframe);
  EXPECT_EQ(read.refused, "");
}

TEST_F(KeptKeyframeFile, AnotherConfigurationSizeOrSetOfRegionsIsRefused) {
  ASSERT_TRUE(written_and_read([](KeptKeyframe&) {}).keyframe);
  EXPECT_THAT(read_keyframe(path, kHash + 1, camera(), 2).refused, HasSubstr("configuration"));
  EXPECT_THAT(read_keyframe(path, kHash, camera(), 3).refused, HasSubstr("regions"));
  core::CameraInfo other = camera();
  other.width_px = 6;
  other.height_px = 8;
  EXPECT_THAT(read_keyframe(path, kHash, other, 2).refused, HasSubstr("different size"));
}

TEST_F(KeptKeyframeFile, SenselessPointsAreRefused) {
  EXPECT_NE(written_and_read([](KeptKeyframe& k) { k.points.points.clear(); }).refused, "");
  EXPECT_NE(written_and_read([](KeptKeyframe& k) { k.points.points[0].u_px = 1e9; }).refused, "");
  EXPECT_NE(written_and_read([](KeptKeyframe& k) { k.points.points[0].v_px = std::nan(""); }).refused, "");
  EXPECT_NE(written_and_read([](KeptKeyframe& k) { k.points.points[0].region = 1; }).refused, "");
  EXPECT_NE(written_and_read([](KeptKeyframe& k) { k.image.pixels.pop_back(); }).refused, "");
}

TEST_F(KeptKeyframeFile, ADamagedFileIsRefused) {
  ASSERT_TRUE(written_and_read([](KeptKeyframe&) {}).keyframe);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(-5, std::ios::end);
  file.put('\x55');
  file.close();
  EXPECT_THAT(read_keyframe(path, kHash, camera(), 2).refused, HasSubstr("checksum"));
}

}  // namespace
}  // namespace app
