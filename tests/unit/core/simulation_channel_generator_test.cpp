#include "core/simulation/channel_generator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/simulation/presets.h"

namespace core::simulation {
namespace {

Scene quiet_paper(double duration_s) {
  Scene scene = make_paper_scene(5, duration_s);
  scene.channels.noise_mm = 0.0;
  return scene;
}

TEST(ChannelGenerator, SamplesEachBodyWhenItsRowIsExposed) {
  const SceneMotion motion(quiet_paper(20.0));
  const ChannelGenerator generator(motion, motion.scene().camera.readout_s);
  core::DisplacementSample sample = generator.sample_prototype();
  FrameTiming timing = generator.timing();
  const auto at = [&](std::size_t channel, double t_s) {  // the mean over the exposure by Simpson's rule
    const int body = static_cast<int>(channel + 1) % 7;
    const double middle_s = t_s + generator.channels()[channel].row_delay_s + 0.002;
    const auto& s = motion.structure();
    return (s.displacement_mm(body, middle_s - 0.002) + 4.0 * s.displacement_mm(body, middle_s) +
            s.displacement_mm(body, middle_s + 0.002)) /
           6.0;
  };
  for (DeliveredFrame frame; timing.next(frame);) {
    generator.generate(frame, sample);
    for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(sample.value_mm[i], at(i, frame.t_s) - at(i, 0.0), 1e-5);
  }
}

TEST(ChannelGenerator, NamesChannelsAsRegionsAndStatesTheDeclaredDelay) {
  const SceneMotion motion(quiet_paper(5.0));
  const ChannelGenerator truth(motion, 0.026), declared(motion, 0.013);
  ASSERT_EQ(truth.channels().size(), 7U);
  EXPECT_EQ(truth.channels().front().name, "floor1");
  EXPECT_EQ(truth.channels().back().name, "base");
  EXPECT_TRUE(truth.channels().back().is_base);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(declared.channels()[i].row_delay_s, 0.5 * truth.channels()[i].row_delay_s, 1e-15);
    EXPECT_GT(truth.channels()[i].row_delay_s, 0.0);
  }
  core::DisplacementSample a, b;  // a wrong declaration does not change the samples
  truth.generate({3, 0.12, 0.12, 3, false}, a);
  declared.generate({3, 0.12, 0.12, 3, false}, b);
  EXPECT_EQ(a.value_mm, b.value_mm);
}

TEST(ChannelGenerator, AddsNoiseAndLossesOfTheDeclaredSizeApart) {
  Scene scene = quiet_paper(40.0);
  const ChannelGenerator quiet(SceneMotion(scene), 0.026);
  scene.channels.noise_mm = 0.05;
  const ChannelGenerator noisy(SceneMotion(scene), 0.026);
  scene.channels.loss_probability = 0.1;
  const ChannelGenerator lossy(SceneMotion(scene), 0.026);
  core::DisplacementSample a, b, c;
  double sum2 = 0.0;
  int n = 0, lost = 0;
  FrameTiming timing = quiet.timing();
  for (DeliveredFrame frame; timing.next(frame);) {
    quiet.generate(frame, a), noisy.generate(frame, b), lossy.generate(frame, c);
    for (std::size_t i = 0; i < 7; ++i, ++n) {
      sum2 += (b.value_mm[i] - a.value_mm[i]) * (b.value_mm[i] - a.value_mm[i]);
      lost += c.seen[i] == 0 ? 1 : 0;
      EXPECT_EQ(b.seen[i], 1);
      if (c.seen[i] != 0) {
        EXPECT_EQ(c.value_mm[i], b.value_mm[i]);
      }
    }
  }
  EXPECT_NEAR(std::sqrt(sum2 / n), 0.05, 5.0 * 0.05 / std::sqrt(2.0 * n));
  EXPECT_NEAR(static_cast<double>(lost) / n, 0.1, 5.0 * std::sqrt(0.09 / n));
}

TEST(ChannelGenerator, RepeatsTheSampleOfARepeatedPicture) {
  Scene scene = quiet_paper(20.0);
  scene.channels.noise_mm = 0.05;
  scene.timing.duplicate_probability = 0.2;
  const ChannelGenerator generator(SceneMotion(scene), 0.026);
  core::DisplacementSample last, sample;
  std::uint64_t shown = 0;
  int repeated = 0;
  FrameTiming timing = generator.timing();
  for (DeliveredFrame frame; timing.next(frame);) {
    generator.generate(frame, sample);
    if (frame.sequence > 0 && frame.number == shown) {
      EXPECT_EQ(sample.value_mm, last.value_mm);
      EXPECT_GT(sample.t_start_ns, last.t_start_ns);
      ++repeated;
    }
    shown = frame.number, last = sample;
  }
  EXPECT_GT(repeated, 50);
}

// A camera turned upside down sees the motion mirrored; its region's axis is the one that points right in the image.
TEST(ChannelGenerator, MeasuresAlongTheAxisInTheImage) {
  Scene scene = quiet_paper(5.0);
  const ChannelGenerator upright(SceneMotion(scene), 0.0);
  scene.camera.roll_rad = std::numbers::pi;
  scene.camera.readout_s = 0.0;
  const ChannelGenerator turned(SceneMotion(scene), 0.0);
  scene.camera.roll_rad = 0.0;
  const ChannelGenerator global(SceneMotion(scene), 0.0);
  core::DisplacementSample a, b;
  turned.generate({50, 2.0, 2.0, 50, false}, a);
  global.generate({50, 2.0, 2.0, 50, false}, b);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(turned.channels()[i].direction_u, 1.0, 1e-3);
    EXPECT_NEAR(a.value_mm[i], -b.value_mm[i], 1e-9);
  }
}

}  // namespace
}  // namespace core::simulation
