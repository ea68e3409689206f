#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "core/identification/mac.h"
#include "core/identification/similar_modes.h"

namespace core {
namespace {

Mode structural(double hz, double mpc, std::vector<std::complex<double>> shape) {
  Mode mode;
  mode.verdict = Verdict::kStructural;
  mode.frequency_hz = hz;
  mode.presence = 1.0;
  mode.mpc = mpc;
  mode.shape = std::move(shape);
  return mode;
}

TEST(Mixtures, AShapeMixedWithThatOfAModeWithinItsWidthIsNone) {
  const std::vector<std::complex<double>> mixed{{1.0, 0.0}, {0.6, 0.45}, {-0.5, 0.1}}, own{0.9, 0.8, -0.6};
  std::vector<Mode> modes{structural(10.73, 0.82, mixed), structural(10.81, 0.98, own)};
  modes[0].damping_ratio = 0.02, modes[1].damping_ratio = 0.008;
  reject_mixtures(modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kNumerical);
  EXPECT_NE(modes[0].reason.find("10.8100 Hz"), std::string::npos) << modes[0].reason;
  EXPECT_EQ(modes[1].verdict, Verdict::kStructural);
}

TEST(Mixtures, ClosePairsOfOtherShapesInPhaseOrResolvedAreKept) {
  const std::vector<std::complex<double>> mixed{{1.0, 0.0}, {0.6, 0.45}, {-0.5, 0.1}}, own{0.9, 0.8, -0.6};
  const auto kept = [&](double hz, double mpc, const std::vector<std::complex<double>>& shape) {
    std::vector<Mode> modes{structural(hz, mpc, shape), structural(10.81, 0.98, own)};
    modes[0].damping_ratio = 0.02, modes[1].damping_ratio = 0.008;
    reject_mixtures(modes);
    return modes[0].verdict == Verdict::kStructural && modes[1].verdict == Verdict::kStructural;
  };
  EXPECT_TRUE(kept(10.73, 0.97, {1.0, 0.3, -0.2})) << "in phase";
  EXPECT_TRUE(kept(10.40, 0.82, mixed)) << "farther apart than their widths";
  EXPECT_TRUE(kept(10.73, 0.82, {{0.5, 0.2}, -1.0, -0.4})) << "another shape";
}

// Floors of a storey frame sway in the shape of sines; rows are scanned in 26 of 40 ms.
struct CloseShapes {
  std::vector<std::complex<double>> own, other, folded;
};
CloseShapes close_shapes() {
  CloseShapes out;
  for (int floor = 1; floor <= 6; ++floor) {
    const double delay_frames = 0.65 - 0.1 * floor;
    out.own.emplace_back(std::sin(3.5 * std::numbers::pi * floor / 6.5));
    out.other.emplace_back(std::sin(5.5 * std::numbers::pi * floor / 6.5));
    out.folded.push_back(out.other.back() * std::polar(1.0, 2.0 * std::numbers::pi * delay_frames));
  }
  return out;
}

std::vector<std::complex<double>> sum(const std::vector<std::complex<double>>& a, double share,
                                      const std::vector<std::complex<double>>& b) {
  std::vector<std::complex<double>> out = a;
  for (std::size_t c = 0; c < a.size(); ++c) out[c] += share * b[c];
  return out;
}

TEST(Mixtures, AFoldedShapeInASmallShareIsFoundWhereTheWholeIsStillInPhase) {
  const CloseShapes shapes = close_shapes();
  for (const double share : {0.25, 0.3}) {
    const auto mixed = sum(shapes.own, share, shapes.folded);
    ASSERT_GT(mpc(mixed), 0.8);
    std::vector<Mode> modes{structural(10.67, mpc(mixed), mixed), structural(10.83, 0.99999, shapes.own)};
    modes[0].damping_ratio = modes[1].damping_ratio = 0.01;
    reject_mixtures(modes);
    EXPECT_EQ(modes[0].verdict, Verdict::kNumerical) << share;
    EXPECT_EQ(modes[1].verdict, Verdict::kStructural) << share;
  }
}

TEST(Mixtures, ARealCloseModeIsKeptHoweverMuchOfTheOtherItsShapeHolds) {
  const CloseShapes shapes = close_shapes();
  for (const double share : {0.5, 1.0, 3.0}) {
    const auto real = sum(shapes.own, share, shapes.other);
    std::vector<Mode> modes{structural(10.67, 0.85, real), structural(10.83, 0.99, shapes.own)};
    modes[0].damping_ratio = modes[1].damping_ratio = 0.01;
    reject_mixtures(modes);
    EXPECT_EQ(modes[0].verdict, Verdict::kStructural) << share;
  }
}

}  // namespace
}  // namespace core
