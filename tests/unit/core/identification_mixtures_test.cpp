#include <gtest/gtest.h>

#include <complex>
#include <utility>
#include <vector>

#include "core/identification/verdict.h"

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
  EXPECT_TRUE(kept(10.73, 0.97, mixed)) << "in phase";
  EXPECT_TRUE(kept(10.40, 0.82, mixed)) << "farther apart than their widths";
  EXPECT_TRUE(kept(10.73, 0.82, {{0.5, 0.2}, -1.0, -0.4})) << "another shape";
}

}  // namespace
}  // namespace core
