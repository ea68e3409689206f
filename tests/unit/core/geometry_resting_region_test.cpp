// The rotation of a static region in the image plane.
#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/channel_displacement.h"
#include "core/types/witness.h"
#include "tests/support/plate_tracks.h"

namespace core {
namespace {

using test_support::Measured;
using test_support::PlateView;

double at_rest(std::size_t, double) { return 0.0; }
double no_zoom(double) { return 1.0; }

TEST(RestingRegion, OfPointsCloseTogetherNoRotationIsMeasured) {
  const PlateView view;
  ChannelDisplacementConfig config = view.config();
  config.following = CameraFollowing::kDistance;
  config.readout.height_px = 4800;
  config.regions[2].role = RegionRole::kBackground;
  EXPECT_EQ(ChannelDisplacement(config, view.frame(0.0, at_rest, no_zoom)).spectra().size(), 3U);
}

TEST(RestingRegion, AWideStaticRegionShowsTheCamerasRotation) {
  const PlateView view;
  ChannelDisplacementConfig config = view.config();
  config.following = CameraFollowing::kDistance;
  config.regions[2].role = RegionRole::kBackground;
  Measured measure(config, view.frame(0.0, at_rest, no_zoom));
  ASSERT_EQ(measure.channels.spectra().size(), 4U);
  EXPECT_TRUE(witnesses_turn(measure.channels.spectra()[3]));
  for (const double turn_rad : {0.0, 0.002, -0.03}) {
    TrackFrame tracks = view.frame(0.1, at_rest, no_zoom);
    for (TrackPoint& p : tracks.points) {  // about the optical axis
      const double u = p.u_px - view.camera.cx, v = p.v_px - view.camera.cy;
      p.u_px = view.camera.cx + std::cos(turn_rad) * u - std::sin(turn_rad) * v;
      p.v_px = view.camera.cy + std::sin(turn_rad) * u + std::cos(turn_rad) * v;
    }
    const DisplacementSample& sample = measure(tracks);
    ASSERT_EQ(sample.witness_mm.size(), 2U);
    EXPECT_EQ(sample.witness_seen[1], 1);
    EXPECT_NEAR(sample.witness_mm[1], config.scale_mm_per_px * 0.5 * config.readout.height_px * std::sin(turn_rad),
                1e-4)
        << turn_rad;
  }
}

}  // namespace
}  // namespace core
