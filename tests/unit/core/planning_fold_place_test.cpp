#include "core/planning/fold_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "core/identification/mac.h"

namespace core::planning {
namespace {

const std::vector<double> kShape{0.3, 0.7, 1.0, -0.4, -0.9, 0.5};

FoldingConfig rows(double span_frames, double max_frequency_hz, double rate_hz = 25.0) {
  FoldingConfig folding{rate_hz, max_frequency_hz, {}};
  for (int c = 0; c < 6; ++c) folding.delay_s.push_back(span_frames / rate_hz * c / 5.0);
  return folding;
}

TEST(FoldPlace, PaperModesFallWhereArithmeticPutsThem) {
  const FoldPlace fifth = fold_place(12.93, 1e-4, kShape, rows(0.5, 16.0));
  EXPECT_NEAR(fifth.apparent_hz, 12.07, 1e-6);
  EXPECT_EQ(fifth.n, -1);
  const FoldPlace sixth = fold_place(14.34, 1e-4, kShape, rows(0.5, 16.0));
  EXPECT_NEAR(sixth.apparent_hz, 10.66, 1e-6);
  EXPECT_EQ(sixth.n, -1);
  EXPECT_EQ(fold_place(27.0, 0.01, kShape, rows(0.5, 40.0)).n, 1);
  EXPECT_NEAR(fold_place(27.0, 1e-4, kShape, rows(0.5, 40.0)).apparent_hz, 2.0, 1e-6);
}

TEST(FoldPlace, NamesWhatElseItCouldBe) {
  const FoldPlace place = fold_place(12.93, 1e-4, kShape, rows(0.5, 37.5));
  ASSERT_EQ(place.rivals_hz.size(), 2U);
  EXPECT_NEAR(place.rivals_hz[0], 12.07, 1e-4);
  EXPECT_NEAR(place.rivals_hz[1], 37.07, 1e-4);
}

TEST(FoldPlace, DirectWhereNothingElseIsPossible) {
  for (const double highest : {12.5, 16.0}) {
    const FoldPlace place = fold_place(5.0, 0.01, kShape, rows(0.5, highest));
    EXPECT_EQ(place.outlook, FoldOutlook::kDirect);
    EXPECT_TRUE(place.rivals_hz.empty());
    EXPECT_FALSE(place.margin.has_value());
  }
}

// One rival: the margin is 1 minus the MPC of the shape corrected for the rival's delays.
TEST(FoldPlace, MarginIsTheLeadInMpc) {
  const FoldingConfig folding = rows(0.3, 16.0);
  const FoldPlace place = fold_place(14.34, 1e-5, kShape, folding);
  std::vector<std::complex<double>> wrong;
  for (std::size_t c = 0; c < kShape.size(); ++c) {
    // The conjugate pole at +10.66 Hz carries exp(+2 pi i 14.34 tau)*; undone with 10.66 Hz the phase of 25 Hz remains.
    wrong.push_back(std::polar(kShape[c], 2.0 * std::numbers::pi * 25.0 * folding.delay_s[c]));
  }
  ASSERT_TRUE(place.margin.has_value());
  EXPECT_NEAR(*place.margin, 1.0 - mpc(wrong), 1e-3);
  EXPECT_EQ(place.outlook, FoldOutlook::kResolved);
}

TEST(FoldPlace, OpenWithoutDelaysOrWithTooFewRegions) {
  EXPECT_EQ(fold_place(14.34, 0.01, kShape, rows(0.0, 16.0)).outlook, FoldOutlook::kNoDelays);
  EXPECT_EQ(fold_place(10.83, 0.01, kShape, rows(0.0, 16.0)).outlook, FoldOutlook::kNoDelays);  // not aliased, yet open
  FoldingConfig two = rows(0.5, 16.0);
  two.delay_s.resize(2);
  EXPECT_EQ(fold_place(14.34, 0.01, {0.5, 1.0}, two).outlook, FoldOutlook::kNoDelays);
}

TEST(FoldPlace, AmbiguousWhereTheDelaysAreShort) {
  const FoldPlace place = fold_place(14.34, 0.01, kShape, rows(0.08, 16.0));
  EXPECT_EQ(place.outlook, FoldOutlook::kAmbiguous);
  EXPECT_LT(*place.margin, 0.3);
}

TEST(FoldPlace, OverlapsAreCountedAgainstTheMeanHalfPowerWidth) {
  // The paper's modes 4 and 6 at 25 fps: 10.83 and 10.66 Hz; widths 0.2166 and 0.2868 Hz.
  const auto found = overlaps({1.657, 10.83, 10.66}, {0.033, 0.2166, 0.2868});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].first, 1U);
  EXPECT_EQ(found[0].second, 2U);
  EXPECT_NEAR(found[0].gap_hz, 0.17, 1e-12);
  EXPECT_NEAR(found[0].width_hz, 0.2517, 1e-12);
  EXPECT_FALSE(found[0].merges);
  EXPECT_TRUE(overlaps({10.83, 10.75}, {0.2166, 0.2868})[0].merges);
  EXPECT_TRUE(overlaps({10.83, 10.5}, {0.2166, 0.2868}).empty());
}

TEST(FoldPlace, ModesAtTheEdgeMeetTheirMirrorImage) {
  EXPECT_TRUE(at_edge(12.45, 0.2, 25.0));
  EXPECT_TRUE(at_edge(0.05, 0.2, 25.0));
  EXPECT_FALSE(at_edge(12.3, 0.2, 25.0));
}

}  // namespace
}  // namespace core::planning
