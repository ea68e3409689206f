#include "core/geometry/channel_displacement.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/types/witness.h"
#include "tests/support/plate_tracks.h"

namespace core {
namespace {

using test_support::Measured;
using test_support::PlateView;

double at_rest(std::size_t, double) { return 0.0; }
double no_zoom(double) { return 1.0; }
double sway(std::size_t r, double t) {
  return 4.0 * static_cast<double>(r + 1) *
         (std::cos(2.0 * std::numbers::pi * 1.7 * t + static_cast<double>(r)) - std::cos(static_cast<double>(r)));
}
double drift(double t) { return 1.0 + 0.02 * std::sin(2.0 * std::numbers::pi * 0.2 * t); }

// Smooth camera motion is followed to a small fraction of a channel's stated 0.02 mm, not exactly.
TEST(ChannelDisplacement, MeasuresEachPlateUnderMotionAndZoom) {
  const PlateView view;
  Measured measure(view.config(), view.frame(0.0, sway, drift));
  for (int k = 0; k < 50; ++k) {
    const double t = k / view.rate_hz;
    TrackFrame tracks = view.frame(t, sway, drift);
    const DisplacementSample& sample = measure(tracks);
    for (std::size_t r = 0; r < 3; ++r) {
      EXPECT_EQ(sample.seen[r], 1);
      EXPECT_EQ(sample.n_points[r], 16);
      EXPECT_NEAR(sample.value_mm[r], sway(r, t), 1e-3) << "floor " << r << " at " << t;
    }
    EXPECT_NEAR(sample.scale_mm_per_px, 2.0 * drift(t), 1e-5);
    EXPECT_EQ(sample.sequence, tracks.sequence);
    EXPECT_EQ(sample.t_start_ns, tracks.t_start_ns);
  }
}

// The third plate is a static wall: it sways as the camera translates, and zooms as it approaches.
TEST(ChannelDisplacement, FollowsWhatRestsAsAWitnessOfTheCamerasShift) {
  const PlateView view;
  ChannelDisplacementConfig config = view.config();
  config.following = CameraFollowing::kDistance;
  config.regions[2].role = RegionRole::kBackground;
  const TrackFrame keyframe = view.frame(0.0, sway, drift);
  double centre_px = 0.0;  // of the wall, from the optical axis: it goes outward as the camera nears
  for (std::size_t i = 32; i < 48; ++i) centre_px += (keyframe.points[i].u_px - view.camera.cx) / 16.0;
  Measured measure(config, keyframe);
  ASSERT_EQ(measure.channels.channels().size(), 2U);
  ASSERT_EQ(measure.channels.spectra().size(), 4U);
  EXPECT_TRUE(measure.channels.spectra()[2].is_witness);
  EXPECT_TRUE(witnesses_turn(measure.channels.spectra()[3]));
  for (int k = 1; k < 50; ++k) {
    const double t = k / view.rate_hz;
    TrackFrame tracks = view.frame(t, sway, drift);
    tracks.points[40].seen = k % 2 == 0;             // seen in every second frame: the mean of the others must not jump
    if (k % 3 == 0) tracks.points[45].u_px += 20.0;  // jumps
    const DisplacementSample& sample = measure(tracks);
    ASSERT_EQ(sample.witness_mm.size(), 2U);
    EXPECT_EQ(sample.witness_seen[0], 1);
    EXPECT_NEAR(sample.witness_mm[1], 0.0, 0.02) << "nothing turns";
    EXPECT_NEAR(sample.witness_mm[0], sway(2, t) / drift(t) + 2.0 * centre_px * (1.0 / drift(t) - 1.0), 0.02) << t;
  }
  config.witness = false;
  EXPECT_EQ(Measured(config, view.frame(0.0, sway, drift)).channels.spectra().size(), 2U);
}

TEST(ChannelDisplacement, UndistortsPoints) {
  PlateView view;
  view.camera.distortion = {-0.3, 0.1, 0.001, -0.001, 0.0};
  Measured measure(view.config(), view.frame(0.0, sway, drift));
  TrackFrame tracks = view.frame(0.2, sway, drift);
  const DisplacementSample& sample = measure(tracks);
  for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(sample.value_mm[r], sway(r, 0.2), 1e-4);
}

TEST(ChannelDisplacement, StatesTheDelayOfEachRowAndLeavesTheSampleThere) {
  PlateView view;
  view.readout_s = 0.03;
  Measured measure(view.config(), view.frame(0.0, at_rest, no_zoom));
  for (std::size_t r = 0; r < 3; ++r) {
    const double v_mean = 236.0 + 0.5 * (view.plate_y_mm[r] - 40.0 + 80.0 * 7.5 / 16.0);
    EXPECT_NEAR(measure.channels.channels()[r].row_delay_s, 0.03 * v_mean / 480.0, 1e-12);
  }
  TrackFrame tracks = view.frame(
      0.48, [](std::size_t, double t) { return 50.0 * t; }, no_zoom);
  const DisplacementSample& sample = measure(tracks);
  for (std::size_t r = 0; r < 3; ++r) {
    // Not exact: rows of one plate are seen at different times, and their shear appears as slight magnification.
    EXPECT_NEAR(sample.value_mm[r], 50.0 * (0.48 + measure.channels.channels()[r].row_delay_s), 1e-4);
  }
}

// Rows are read at their position on the sensor, not where an undistorted camera would see them.
TEST(ChannelDisplacement, TakesTheDelayFromTheRawRow) {
  PlateView view;
  view.readout_s = 0.03;
  view.camera.distortion = {-0.4, 0.1, 0.0, 0.0, 0.0};
  const TrackFrame keyframe = view.frame(0.0, at_rest, no_zoom);
  const Measured measure(view.config(), keyframe);
  double v_sum = 0.0;
  for (std::size_t i = 0; i < 16; ++i) v_sum += keyframe.points[i].v_px;
  EXPECT_NEAR(measure.channels.channels()[0].row_delay_s, 0.03 * v_sum / 16.0 / 480.0, 1e-12);
}

// A channel weights its points by their texture, and its delay is the same weighted mean of theirs.
TEST(ChannelDisplacement, WeighsPointsByTextureInValueAndDelayAlike) {
  PlateView view;
  view.readout_s = 0.03;
  const auto steady = [](std::size_t, double t) { return 100.0 * t; };
  const auto with_weights = [](TrackFrame frame) {
    for (std::size_t i = 0; i < frame.points.size(); ++i) frame.points[i].sigma_px = i % 16 < 4 ? 0.02 : 0.2;
    return frame;
  };
  ChannelDisplacementConfig config = view.config();
  config.adaptive_scale = false;
  config.inlier_sigma_px = 1.0;
  Measured measure(config, with_weights(view.frame(0.0, at_rest, no_zoom)));
  const double plain_s = 0.03 * (236.0 + 0.5 * (-340.0 + 80.0 * 7.5 / 16.0)) / 480.0;
  EXPECT_LT(measure.channels.channels()[0].row_delay_s, plain_s - 1e-4) << "the first rows weigh more";
  TrackFrame tracks = with_weights(view.frame(0.2, steady, no_zoom));
  const DisplacementSample& sample = measure(tracks);
  for (std::size_t r = 0; r < 3; ++r) {
    EXPECT_NEAR(sample.value_mm[r], 100.0 * (0.2 + measure.channels.channels()[r].row_delay_s), 1e-9);
  }
}

TEST(ChannelDisplacement, LostPointsAreLeftOutAndTooFewAreNotSeen) {
  const PlateView view;
  Measured measure(view.config(), view.frame(0.0, sway, drift));
  TrackFrame tracks = view.frame(0.2, sway, drift);
  for (std::size_t i = 0; i < 10; ++i) tracks.points[i].seen = false;
  for (std::size_t i = 16; i < 30; ++i) tracks.points[i].seen = false;
  const DisplacementSample& sample = measure(tracks);
  EXPECT_EQ(sample.n_points[0], 6);
  EXPECT_NEAR(sample.value_mm[0], sway(0, 0.2), 1e-3);
  EXPECT_EQ(sample.n_points[1], 2);
  EXPECT_EQ(sample.seen[1], 0);
  EXPECT_EQ(sample.value_mm[1], 0.0);
  EXPECT_EQ(sample.seen[2], 1);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_FALSE(tracks.points[i].inlier);
}

TEST(ChannelDisplacement, OutliersAreMarkedAndLeftOut) {
  const PlateView view;
  Measured measure(view.config(), view.frame(0.0, sway, drift));
  TrackFrame tracks = view.frame(0.2, sway, drift);
  for (const std::size_t wild : {3U, 20U, 21U}) tracks.points[wild].u_px += 9.0;
  const DisplacementSample& sample = measure(tracks);
  for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(sample.value_mm[r], sway(r, 0.2), 1e-3);
  for (std::size_t i = 0; i < tracks.points.size(); ++i)
    EXPECT_EQ(tracks.points[i].inlier, i != 3 && i != 20 && i != 21) << i;
}

TEST(ChannelDisplacement, AFrameWithoutAPointHasNoSampleAndNoNaN) {
  ChannelDisplacementConfig config = PlateView().config();
  for (const int min_points : {3, 0}) {
    config.min_points = min_points;
    Measured measure(config, PlateView().frame(0.0, at_rest, no_zoom));
    TrackFrame none = PlateView().frame(0.04, at_rest, no_zoom);
    for (TrackPoint& point : none.points) point.seen = false;
    const DisplacementSample& sample = measure(none);
    for (std::size_t r = 0; r < 3; ++r) {
      EXPECT_EQ(sample.seen[r], 0);
      EXPECT_TRUE(std::isfinite(sample.value_mm[r]) && std::isfinite(sample.sigma_mm[r]));
    }
    EXPECT_TRUE(std::isfinite(sample.scale_mm_per_px));
  }
}

// A lens model extrapolated far beyond the image has no inverse there: that point is lost, its region is not.
TEST(ChannelDisplacement, APointThatCannotBeUndistortedIsLostAlone) {
  PlateView view;
  view.camera.distortion = {-0.4, 0.0, 0.0, 0.0, 0.0};
  Measured measure(view.config(), view.frame(0.0, sway, drift));
  TrackFrame tracks = view.frame(0.2, sway, drift);
  tracks.points[2].u_px = 50000.0;
  tracks.points[5].v_px = std::numeric_limits<double>::quiet_NaN();
  const DisplacementSample& sample = measure(tracks);
  EXPECT_EQ(sample.n_points[0], 14);
  for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(sample.value_mm[r], sway(r, 0.2), 1e-4);
}

TEST(ChannelDisplacement, SigmaIsThatOfTheMean) {
  const PlateView view;
  ChannelDisplacementConfig config = view.config();
  config.adaptive_scale = false;
  Measured measure(config, view.frame(0.0, at_rest, no_zoom));
  TrackFrame tracks = view.frame(0.04, at_rest, no_zoom);
  EXPECT_NEAR(measure(tracks).sigma_mm[0], 2.0 * 0.04 / 4.0, 1e-9);
}

TEST(ChannelDisplacement, NamesChannelsByRegionAndAxis) {
  ChannelDisplacementConfig config = PlateView().config();
  config.regions[0].role = RegionRole::kBackground;
  config.regions[1].both_axes = true;
  config.regions[2].role = RegionRole::kBase;
  config.regions[2].axis_deg = 90.0;
  const ChannelDisplacement channels(config, PlateView().frame(0.0, at_rest, no_zoom));
  ASSERT_EQ(channels.channels().size(), 3U);
  EXPECT_EQ(channels.channels()[0].name, "floor2.u");
  EXPECT_EQ(channels.channels()[1].name, "floor2.v");
  EXPECT_EQ(channels.channels()[1].direction_v, 1.0);
  EXPECT_EQ(channels.channels()[2].name, "floor3");
  EXPECT_EQ(channels.channels()[2].region, 2);
  EXPECT_NEAR(channels.channels()[2].direction_v, 1.0, 1e-15);
  EXPECT_TRUE(channels.channels()[2].is_base);
  EXPECT_FALSE(channels.channels()[0].is_base);
}

TEST(ChannelDisplacement, WithoutAdaptiveScaleZoomIsTakenForMotion) {
  ChannelDisplacementConfig config = PlateView().config();
  config.adaptive_scale = false;
  Measured measure(config, PlateView().frame(0.0, at_rest, no_zoom));
  TrackFrame tracks = PlateView().frame(
      0.04, [](std::size_t, double) { return 3.0; }, no_zoom);
  EXPECT_NEAR(measure(tracks).value_mm[1], 3.0, 1e-9);
  EXPECT_EQ(measure.sample.scale_mm_per_px, 2.0);
}

TEST(ChannelDisplacementPaper, MovesSamplesToRowZeroAssumingAFullFrameOfReadout) {
  PlateView view;
  view.readout_s = 1.0 / view.rate_hz;  // rho = 1, as Eq. 7 has it
  ChannelDisplacementConfig config = view.config();
  config.paper_method = true;
  config.adaptive_scale = false;
  const auto steady = [](std::size_t, double t) { return 30.0 * t; };
  Measured paper(config, view.frame(0.0, steady, no_zoom));
  EXPECT_EQ(paper.channels.channels()[2].row_delay_s, 0.0);
  std::array<double, 3> begin_mm{};
  for (int k = 0; k <= 5; ++k) {
    TrackFrame tracks = view.frame(k / view.rate_hz, steady, no_zoom);
    const DisplacementSample& sample = paper(tracks);
    for (std::size_t r = 0; r < 3; ++r) {
      if (k == 1) begin_mm[r] = sample.value_mm[r];
      // Steady motion: as seen by row 0, except for the keyframe's own constant offset.
      if (k > 1) {
        EXPECT_NEAR(sample.value_mm[r] - begin_mm[r], 30.0 * (k - 1) / view.rate_hz, 1e-9);
      }
    }
  }
  EXPECT_NEAR(begin_mm[2] - begin_mm[0], -30.0 / view.rate_hz * (600.0 / 2.0) / 480.0, 1e-6)
      << "the keyframe keeps its own delay";
}

// With half the readout the paper's assumption corrects twice too much; method hovermodal states the true delay.
TEST(ChannelDisplacementPaper, OvercorrectsWhenTheReadoutIsShorterThanTheFrame) {
  PlateView view;
  view.readout_s = 0.5 / view.rate_hz;
  ChannelDisplacementConfig config = view.config();
  config.adaptive_scale = false;
  const auto wave = [](std::size_t, double t) { return 10.0 * std::sin(2.0 * std::numbers::pi * 1.0 * t); };
  config.paper_method = true;
  Measured paper(config, view.frame(0.0, at_rest, no_zoom));
  config.paper_method = false;
  Measured ours(config, view.frame(0.0, at_rest, no_zoom));
  double paper_error = 0.0;
  double ours_error = 0.0;
  for (int k = 0; k < 50; ++k) {
    const double t = k / view.rate_hz;
    TrackFrame tracks = view.frame(t, wave, no_zoom);
    paper_error = std::max(paper_error, std::abs(paper(tracks).value_mm[2] - wave(2, t)));
    ours_error =
        std::max(ours_error, std::abs(ours(tracks).value_mm[2] - wave(2, t + ours.channels.channels()[2].row_delay_s)));
  }
  EXPECT_GT(paper_error, 0.5);
  EXPECT_LT(ours_error, 0.02) << "what is left is the spread of rows inside the region";
}

}  // namespace
}  // namespace core
