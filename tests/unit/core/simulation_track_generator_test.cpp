#include "core/simulation/track_generator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace core::simulation {
namespace {

TEST(TrackGenerator, SeesEachPointAtTheTimeOfItsRow) {
  const SceneMotion motion(make_paper_scene(1, 30.0));
  for (int body = 0; body < 7; ++body) {
    const PlanePoint point{20.0, motion.scene().body_y_mm(body)};
    const ImagePoint image = motion.see(body, point, 11.0);
    const double t_s = 11.0 + 0.026 * image.v_px / 1080.0 + 0.002;
    const ImagePoint again = project(motion.scene().camera, motion.hover().at(t_s),
                                     20.0 + motion.structure().displacement_mm(body, t_s), point.y_mm, 2000.0);
    EXPECT_NEAR(image.u_px, again.u_px, 1e-9);
    EXPECT_NEAR(image.v_px, again.v_px, 1e-9);
  }
}

TEST(TrackGenerator, AddsNoiseOfTheDeclaredSpreadAndNothingElse) {
  const TrackGenerator tracks(make_paper_scene(1, 10.0), {30, 0.03, 0.0});
  core::TrackFrame noisy, truth;
  double sum = 0.0, sum2 = 0.0;
  int n = 0;
  for (std::uint64_t frame = 0; frame < 250; ++frame) {
    tracks.generate(frame, noisy);
    tracks.generate_true(frame, truth);
    ASSERT_EQ(noisy.points.size(), 240U);
    for (std::size_t i = 0; i < noisy.points.size(); ++i) {
      EXPECT_TRUE(noisy.points[i].seen);
      for (const double d :
           {noisy.points[i].u_px - truth.points[i].u_px, noisy.points[i].v_px - truth.points[i].v_px}) {
        sum += d, sum2 += d * d, ++n;
      }
    }
  }
  EXPECT_NEAR(sum / n, 0.0, 5 * 0.03 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(sum2 / n), 0.03, 5 * 0.03 / std::sqrt(2.0 * n));
}

TEST(TrackGenerator, LosesTheDeclaredShareAndLeavesTheRestAlone) {
  const Scene scene = make_paper_scene(1, 10.0);
  const TrackGenerator whole(scene, {30, 0.03, 0.0}), lossy(scene, {30, 0.03, 0.05});
  core::TrackFrame a, b;
  int lost = 0, n = 0;
  for (std::uint64_t frame = 0; frame < 250; ++frame) {
    whole.generate(frame, a);
    lossy.generate(frame, b);
    for (std::size_t i = 0; i < a.points.size(); ++i, ++n) {
      EXPECT_EQ(a.points[i].u_px, b.points[i].u_px);
      EXPECT_EQ(b.points[i].seen, b.points[i].inlier);
      lost += b.points[i].seen ? 0 : 1;
    }
  }
  EXPECT_NEAR(lost / static_cast<double>(n), 0.05, 5 * std::sqrt(0.05 / n));
}

TEST(TrackGenerator, GivesAFrameAloneOrInSequence) {
  const TrackGenerator tracks(make_paper_scene(1, 10.0), {});
  core::TrackFrame sequence, alone;
  for (std::uint64_t frame = 0; frame <= 20; ++frame) tracks.generate(frame, sequence);
  TrackGenerator(make_paper_scene(1, 10.0), {}).generate(20, alone);
  EXPECT_EQ(alone.t_start_ns, 800'000'000);
  ASSERT_EQ(alone.points.size(), sequence.points.size());
  for (std::size_t i = 0; i < alone.points.size(); ++i) EXPECT_EQ(alone.points[i].u_px, sequence.points[i].u_px);
}

TEST(TrackGenerator, RefusesBadOptions) {
  const Scene scene = make_paper_scene(1, 10.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(TrackGenerator(scene, {0, 0.03, 0.0}), std::invalid_argument);
  EXPECT_THROW(TrackGenerator(scene, {30, nan, 0.0}), std::invalid_argument);
  EXPECT_THROW(TrackGenerator(scene, {30, -0.1, 0.0}), std::invalid_argument);
  EXPECT_THROW(TrackGenerator(scene, {30, 0.03, 1.5}), std::invalid_argument);
}

}  // namespace
}  // namespace core::simulation
