#include "core/simulation/camera/frame_timing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/simulation/presets.h"

namespace core::simulation {
namespace {

std::vector<DeliveredFrame> all_frames(const Scene& scene) {
  FrameTiming timing(scene);
  std::vector<DeliveredFrame> frames;
  for (DeliveredFrame frame; timing.next(frame);) frames.push_back(frame);
  return frames;
}

TEST(FrameTiming, IsEvenUnlessToldOtherwise) {
  const auto frames = all_frames(make_paper_scene(1, 10.0));
  ASSERT_EQ(frames.size(), 250U);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].number, k);
    EXPECT_EQ(frames[k].sequence, k);
    EXPECT_EQ(frames[k].t_s, static_cast<double>(k) / 25.0);
    EXPECT_EQ(frames[k].stamp_s, frames[k].t_s);
    EXPECT_FALSE(frames[k].gap_before);
  }
}

TEST(FrameTiming, SaysWhereFramesAreMissingWhenStampsTell) {
  Scene scene = make_paper_scene(1, 100.0);
  scene.timing.drop_probability = 0.1;
  const auto frames = all_frames(scene);
  EXPECT_NEAR(static_cast<double>(frames.size()), 2250.0, 5 * std::sqrt(225.0));
  for (std::size_t k = 1; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].gap_before, frames[k].sequence != frames[k - 1].sequence + 1);
    EXPECT_EQ(frames[k].stamp_s, frames[k].t_s);
  }
  EXPECT_EQ(frames.front().number, 0U);
}

TEST(FrameTiming, HidesDropsAndJitterWhenStampsDoNotTell) {
  Scene scene = make_paper_scene(1, 100.0);
  scene.timing.drop_probability = 0.1;
  scene.timing.jitter_rms_s = 0.002;
  scene.timing.stamps_tell = false;
  const auto frames = all_frames(scene);
  double square = 0.0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].sequence, k);
    EXPECT_EQ(frames[k].stamp_s, static_cast<double>(k) / 25.0);
    EXPECT_FALSE(frames[k].gap_before);
    square += std::pow(frames[k].t_s - static_cast<double>(frames[k].number) / 25.0, 2);
  }
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(frames.size())), 0.002, 1.5e-4);
}

TEST(FrameTiming, ShowsTheLastPictureAgainForADuplicate) {
  Scene scene = make_paper_scene(1, 100.0);
  scene.timing.duplicate_probability = 0.1;
  const auto frames = all_frames(scene);
  ASSERT_EQ(frames.size(), 2500U);
  int n_repeated = 0;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    if (frames[k].number == k) continue;
    ++n_repeated;
    EXPECT_EQ(frames[k].number, frames[k - 1].number);
    EXPECT_EQ(frames[k].t_s, frames[k - 1].t_s);
    EXPECT_EQ(frames[k].sequence, k);
  }
  EXPECT_NEAR(n_repeated, 250.0, 5 * std::sqrt(225.0));
}

// Switching one part on leaves the others as they were.
TEST(FrameTiming, DrawsEachPartFromItsOwnStream) {
  Scene drops = make_paper_scene(1, 100.0), both = drops;
  drops.timing.drop_probability = both.timing.drop_probability = 0.1;
  both.timing.jitter_rms_s = 0.002;
  const auto a = all_frames(drops), b = all_frames(both);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].number, b[k].number);
}

}  // namespace
}  // namespace core::simulation
