#include "core/tracking/view_match.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace core {
namespace {

// Two regions of twelve points each.
TrackFrame view() {
  TrackFrame tracks;
  for (std::uint16_t region = 0; region < 2; ++region) {
    for (int i = 0; i < 12; ++i) {
      TrackPoint point;
      point.region = region;
      point.u_px = 100.0 + 30.0 * (i % 4);
      point.v_px = 50.0 + 200.0 * region + 25.0 * (i / 4);
      point.seen = true;
      tracks.points.push_back(point);
    }
  }
  return tracks;
}

std::string reason(const std::function<void(std::size_t, TrackPoint&)>& change) {
  TrackFrame now = view();
  for (std::size_t i = 0; i < now.points.size(); ++i) change(i, now.points[i]);
  return why_other_view(view(), now, 3);
}

TEST(ViewMatch, TheSameViewMayHaveDriftedTurnedAndItsStructureMoved) {
  EXPECT_EQ(reason([](std::size_t, TrackPoint&) {}), "");
  EXPECT_EQ(reason([](std::size_t i, TrackPoint& p) {
              const double u = p.u_px, v = p.v_px;
              p.u_px = 1.01 * (u - 0.03 * v) + 40.0 + (p.region == 0 ? 4.0 : 0.0);
              p.v_px = 1.01 * (0.03 * u + v) - 15.0;
              p.seen = i % 12 > 3;  // a third of each region is not found
            }),
            "");
}

TEST(ViewMatch, PointsFoundHereAndThereAreAnotherView) {
  EXPECT_NE(reason([](std::size_t i, TrackPoint& p) {
              p.u_px += 20.0 * std::sin(static_cast<double>(i * i));
              p.v_px += 20.0 * std::cos(3.0 * static_cast<double>(i * i));
            }),
            "");
}

TEST(ViewMatch, ARegionWithTooFewPointsIsAnotherView) {
  EXPECT_NE(reason([](std::size_t i, TrackPoint& p) { p.seen = i < 12 || i > 18; }), "");
  EXPECT_NE(reason([](std::size_t, TrackPoint& p) { p.seen = false; }), "");
}

TEST(ViewMatch, AnotherMagnificationIsAnotherView) {
  EXPECT_NE(reason([](std::size_t, TrackPoint& p) { p.u_px *= 1.08, p.v_px *= 1.08; }), "");
}

TEST(ViewMatch, PointsThatAgreeAreInliersAndNoOthers) {
  TrackFrame now = view();
  now.points[5].u_px += 9.0;
  now.points[7].seen = false;
  EXPECT_EQ(why_other_view(view(), now, 3), "");
  for (std::size_t i = 0; i < now.points.size(); ++i) EXPECT_EQ(now.points[i].inlier, i != 5 && i != 7) << i;
}

}  // namespace
}  // namespace core
