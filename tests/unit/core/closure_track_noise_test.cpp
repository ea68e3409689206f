#include "core/closure/observation/track_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "core/closure/noise_stream.h"

namespace core::closure {
namespace {

constexpr Eigen::Index kRows = 40, kFrames = 1500;
constexpr double kRate_hz = 30.0;

// First-order noise: `kept` of a frame's error persists to the next, except at the first frame of each group.
Eigen::MatrixXd coded(double kept, int group_frames, std::uint64_t seed) {
  NoiseStream noise(seed);
  Eigen::MatrixXd out(kRows, kFrames);
  for (Eigen::Index k = 0; k < kFrames; ++k) {
    const bool is_first = k == 0 || (group_frames > 0 && k % group_frames == 0);
    for (Eigen::Index i = 0; i < kRows; ++i) {
      const double fresh = noise.gaussian();
      out(i, k) = is_first ? fresh : kept * out(i, k - 1) + std::sqrt(1.0 - kept * kept) * fresh;
    }
  }
  return out;
}

TEST(TrackNoise, OfASensorIsIndependentFromFrameToFrame) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const TrackNoise found = track_noise(coded(0.0, 0, seed), kRate_hz);
    EXPECT_EQ(found.correlation_s, 0.0);
    EXPECT_EQ(found.group_frames, 0) << found.group_change;
  }
}

TEST(TrackNoise, FindsTheTimeInWhichErrorsPersist) {
  const TrackNoise found = track_noise(coded(0.9, 0, 4), kRate_hz);
  EXPECT_NEAR(found.correlation_s, -1.0 / std::log(0.9) / kRate_hz, 0.1 * found.correlation_s);
  EXPECT_EQ(found.group_frames, 0) << found.group_change;
}

TEST(TrackNoise, FindsTheGroupOfPictures) {
  const TrackNoise found = track_noise(coded(0.9, 12, 5), kRate_hz);
  EXPECT_EQ(found.group_frames, 12);
  EXPECT_NEAR(found.group_change, std::sqrt(1.0 / (1.0 - 0.9)), 0.2);  // E (a - b)^2: 2 where fresh, 2 (1 - kept) else
}

TEST(TrackNoise, GapsAreNoChanges) {
  Eigen::MatrixXd residual = coded(0.9, 0, 6);
  for (Eigen::Index k = 20; k < kFrames; k += 20) residual.col(k).setZero();
  EXPECT_EQ(track_noise(residual, kRate_hz).group_frames, 0);
}

TEST(TrackNoise, AShortRecordHasNoPeriod) {
  const TrackNoise found = track_noise(coded(0.5, 0, 7).leftCols(3), kRate_hz);
  EXPECT_EQ(found.correlation_s, 0.0);
  EXPECT_EQ(found.group_frames, 0);
}

}  // namespace
}  // namespace core::closure
