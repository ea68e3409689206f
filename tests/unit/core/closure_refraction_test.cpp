#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/observation/field_drift.h"
#include "core/closure/observation/observation_level.h"
#include "core/closure/observation/random_field.h"
#include "core/simulation/injected/shimmer.h"
#include "tests/support/swaying_record.h"

namespace core::closure {
namespace {

using test_support::swaying_record;

constexpr Eigen::Index kFrames = 1000;

simulation::ShimmerParameters air(double rms_px) {
  simulation::ShimmerParameters p;
  p.rms_px = rms_px, p.outer_px = 2000.0, p.inner_px = 200.0;
  p.drift_px_s = {100.0, 0.0}, p.boiling_px_s = 20.0;
  return p;
}

ObservationRecord with_air(double rms_px, std::uint64_t seed) {
  ObservationRecord record = swaying_record(kFrames, {});
  const simulation::Shimmer shimmer(air(rms_px), seed);
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    const double u = record.u_px.col(j).mean(), v = record.v_px.col(j).mean();
    for (Eigen::Index k = 0; k < kFrames; ++k) {
      const auto shift = shimmer.at(u, v, static_cast<double>(k) / record.rate_hz);
      record.u_px(k, j) += shift.u_px, record.v_px(k, j) += shift.v_px;
    }
  }
  return record;
}

ClosureResult closed(const ObservationRecord& record) {
  ObservationLevel level(record);
  ClosureOptions options;
  options.n_surrogates = 8;
  return close_loop(level, options);
}

TEST(Refraction, IsNamedWithItsSizeAndDrift) {
  constexpr double kRms_px = 0.1;  // noise: 0.03
  const ClosureResult result = closed(with_air(kRms_px, 1));
  ASSERT_FALSE(result.steps.empty()) << result.stop_reason;
  for (std::size_t i = 1; i < result.steps.size(); ++i)  // what the family of covariances leaves has no name
    EXPECT_EQ(result.steps[i].kind, EffectKind::kLatent) << result.steps[i].effect;
  const ClosureStep& step = result.steps.front();
  EXPECT_EQ(step.effect, "refraction of the air");
  ASSERT_EQ(step.parameters.size(), 5U);
  EXPECT_NEAR(step.parameters[0].value, kRms_px, 0.25 * kRms_px);
  EXPECT_NEAR(step.parameters[2].value, 100.0, 40.0);
  EXPECT_NEAR(step.parameters[3].value, 0.0, 40.0);
  EXPECT_LT(step.heldout_after, 0.7 * step.heldout_before);
}

// Errors that neighbours share in many patterns, but that stand: those of a codec.
TEST(Refraction, ErrorsThatDoNotDriftAreNotNamedSo) {
  ObservationRecord record = swaying_record(kFrames, {});
  for (const Eigen::Index axis : {0, 1}) {
    Eigen::MatrixXd& positions = axis == 0 ? record.u_px : record.v_px;
    NoiseStream noise(11 + static_cast<std::uint64_t>(axis));
    Eigen::MatrixXd field(kFrames, record.n_points());
    for (Eigen::Index j = 0; j < field.cols(); ++j) {
      double kept = 0.0;
      for (Eigen::Index k = 0; k < kFrames; ++k) {
        kept = 0.95 * kept + 0.3 * noise.gaussian();
        field(k, j) = kept + (j % 8 > 0 ? 0.8 * field(k, j - 1) : 0.0);
      }
    }
    positions += 0.1 / std::sqrt(field.squaredNorm() / static_cast<double>(field.size())) * field;
  }
  for (const ClosureStep& step : closed(record).steps) EXPECT_NE(step.effect, "refraction of the air");
}

TEST(RandomField, OfNoiseHasNoSize) {
  const ObservationLevel level(swaying_record(kFrames, {}));
  const FitView fit = level.state().view();
  NoiseStream noise(3);
  Eigen::MatrixXd white(2 * fit.record.n_points(), kFrames);
  for (double& value : white.reshaped()) value = noise.gaussian();
  const RandomField field(fit);
  const FieldSize size = field.size(residual_moments(fit.model.left_of(white), fit.record.rate_hz));
  EXPECT_LT(size.gain, 1e-3 * static_cast<double>(white.size()));
  EXPECT_NEAR(field.freedom(size), 0.0, 1e-2 * static_cast<double>(white.size()));
}

TEST(RandomField, OfOnePatternHasOnePattern) {
  const ObservationLevel level(swaying_record(kFrames, {}));
  const FitView fit = level.state().view();
  NoiseStream noise(4);
  Eigen::VectorXd pattern(2 * fit.record.n_points());
  for (Eigen::Index j = 0; j < pattern.size() / 2; ++j)
    pattern.segment<2>(2 * j).setConstant(std::sin(0.3 * static_cast<double>(j)));
  Eigen::MatrixXd series(pattern.size(), kFrames);
  for (Eigen::Index k = 0; k < kFrames; ++k) {
    const double amplitude = 5.0 * noise.gaussian();
    for (Eigen::Index i = 0; i < series.rows(); ++i) series(i, k) = amplitude * pattern(i) + noise.gaussian();
  }
  const ResidualMoments moments = residual_moments(fit.model.left_of(series), fit.record.rate_hz);
  const RandomField field(fit);
  const FieldSize size = field.size(moments);
  ASSERT_GT(size.gain, 0.0);
  EXPECT_NEAR(field.n_patterns(size, moments), 1.0, 0.3);
}

TEST(FieldDrift, FindsTheVelocityOfAFrozenField) {
  const ObservationRecord record = swaying_record(kFrames, {});
  const PointGeometry geometry = point_geometry(record);
  simulation::ShimmerParameters p = air(1.0);
  p.drift_px_s = {-40.0, 70.0}, p.boiling_px_s = 0.0;
  const simulation::Shimmer shimmer(p, 5);
  Eigen::MatrixXd field(2 * record.n_points(), kFrames);
  for (Eigen::Index k = 0; k < kFrames; ++k) {
    for (Eigen::Index j = 0; j < record.n_points(); ++j) {
      const auto shift = shimmer.at(geometry.alpha_px * geometry.x(j), geometry.alpha_px * geometry.y(j),
                                    static_cast<double>(k) / record.rate_hz);
      field(2 * j, k) = shift.u_px, field(2 * j + 1, k) = shift.v_px;
    }
  }
  const FieldDrift drift = field_drift(field, geometry, record.rate_hz);
  EXPECT_NEAR(drift.u_px_s, -40.0, 3.0 * drift.sigma_px_s);
  EXPECT_NEAR(drift.v_px_s, 70.0, 3.0 * drift.sigma_px_s);
  EXPECT_GT(drift.likeness, 0.3);
}

}  // namespace
}  // namespace core::closure
