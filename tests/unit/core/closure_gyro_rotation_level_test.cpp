#include "core/closure/observation/gyro_rotation_level.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/shaken_camera.h"

namespace core::closure {
namespace {

using test_support::kFrame_s;
using test_support::kOffset_s;
using test_support::ShakenCamera;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNoise_px = 0.1;
constexpr int kPairs = 60;

GyroRotationLevel level_of(const ShakenCamera& clip) { return GyroRotationLevel(clip.pairs, clip.gyro, clip.config); }

// Adopts the only open candidate that is not refused and whose score no surrogate approaches.
void adopt_first(GyroRotationLevel& level, const std::string& effect) {
  const CandidateScore score = level.score().front();
  ASSERT_EQ(score.effect, effect);
  ASSERT_EQ(score.refusal, "");
  for (std::uint64_t seed = 1; seed <= 6; ++seed) EXPECT_LT(level.surrogate_score(seed), 0.7 * score.score) << seed;
  level.adopt(0);
}

TEST(GyroRotationLevel, TracesAnUndeclaredTurnAndThenTheReadout) {
  GyroRotationLevel level = level_of(ShakenCamera(0.7 * kFrame_s, kNoise_px, 2, kPairs));
  const LevelFit before = level.fit();
  const double turn_before = *level.reference_error();
  adopt_first(level, "camera rotation");
  const LevelFit turned = level.fit();
  EXPECT_LT(turned.heldout, 0.6 * before.heldout);
  const double turn_between = *level.reference_error();
  adopt_first(level, "readout time");
  const LevelFit after = level.fit();
  EXPECT_LT(after.heldout, 0.3 * turned.heldout);
  EXPECT_LT(after.heldout, 1.2 * after.noise_floor);
  EXPECT_NEAR(level.parameters(0).front().value, 1e3 * kOffset_s, 1.0);
  const ParameterValue readout = level.parameters(1).front();
  ASSERT_TRUE(readout.sigma.has_value());
  EXPECT_NEAR(readout.value, 700.0 * kFrame_s, 3.5 * *readout.sigma);
  // The residual rotation estimated from the image alone decreases with each.
  EXPECT_LT(turn_between, 0.5 * turn_before);
  EXPECT_LT(*level.reference_error(), 0.3 * turn_between);
}

TEST(GyroRotationLevel, AGlobalShuttersReadoutIsImmaterial) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    GyroRotationLevel level = level_of(ShakenCamera(0.0, kNoise_px, seed, kPairs));
    (void)level.fit();
    level.adopt(0);
    (void)level.fit();
    EXPECT_EQ(level.score().front().refusal, "immaterial") << seed;
  }
}

TEST(GyroRotationLevel, ReadoutIsRefusedWhileNothingTurns) {
  GyroRotationLevel level = level_of(ShakenCamera(0.7 * kFrame_s, kNoise_px, 1, kPairs));
  (void)level.fit();
  EXPECT_THAT(level.candidates(), ElementsAre("camera rotation", "readout time"));
  EXPECT_THAT(level.score().at(1).refusal, HasSubstr("the model has none"));
  level.adopt(0);
  (void)level.fit();
  EXPECT_THAT(level.candidates(), ElementsAre("readout time"));
  EXPECT_EQ(level.score().at(0).refusal, "");
  EXPECT_THROW(level.adopt(1), std::invalid_argument);
  level.drop();
  EXPECT_THROW(level.drop(), std::invalid_argument);
}

TEST(GyroRotationLevel, AGyroOfAnotherFlightIsImmaterial) {
  ShakenCamera clip(0.0, kNoise_px, 1, kPairs);
  clip.gyro = ShakenCamera(0.0, kNoise_px, 2, kPairs).gyro;
  GyroRotationLevel level = level_of(clip);
  (void)level.fit();
  EXPECT_EQ(level.score().front().refusal, "immaterial");
}

TEST(GyroRotationLevel, ReplaysToTheSameBits) {
  const ShakenCamera clip(0.4 * kFrame_s, kNoise_px, 1, kPairs);
  GyroRotationLevel one = level_of(clip), other = level_of(clip);
  EXPECT_EQ(one.fit().heldout, other.fit().heldout);
  EXPECT_EQ(one.surrogate_score(5), other.surrogate_score(5));
  EXPECT_NE(one.surrogate_score(5), one.surrogate_score(6));
}

TEST(GyroRotationLevel, RefusesARecordWithNothingHeldOut) {
  ShakenCamera clip(0.0, kNoise_px, 1, kPairs);
  for (FramePair& pair : clip.pairs) pair.held_out = false;
  EXPECT_THROW((void)level_of(clip), std::invalid_argument);
}

}  // namespace
}  // namespace core::closure
