#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/observation/course_fit.h"
#include "core/closure/observation/observation_level.h"
#include "tests/support/swaying_record.h"

namespace core::closure {
namespace {

using test_support::kPi;
using test_support::swaying_record;

// Each point has an error in a direction of its own: px times course(its place along v, seconds).
template <class Course>
void add_error(ObservationRecord& record, double px, Course course) {
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    const double direction = 2.4 * static_cast<double>(j * j);
    for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
      const double c = px * course(record.v_px(k, j), static_cast<double>(k) / record.rate_hz);
      record.u_px(k, j) += c * std::cos(direction), record.v_px(k, j) += c * std::sin(direction);
    }
  }
}

void add_zoom(ObservationRecord& record, double rms) {
  for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
    const double zoom = rms * std::sqrt(2.0) * std::sin(0.8 * static_cast<double>(k) / record.rate_hz);
    record.u_px.row(k).array() += zoom * (record.u_px.row(k).array() - record.cx_px);
    record.v_px.row(k).array() += zoom * (record.v_px.row(k).array() - record.cy_px);
  }
}

ClosureResult result_of(const ObservationRecord& record) {
  ObservationLevel level(record);
  ClosureOptions options;
  options.n_surrogates = 8;
  return close_loop(level, options);
}

TEST(ObservationCourses, TemplatesThatDoNotFollowTheScaleAreNamedWithTheirError) {
  ObservationRecord record = swaying_record(1000, {});
  add_zoom(record, 0.004);
  add_error(record, 10.0, [](double, double t) { return 0.004 * std::sqrt(2.0) * std::sin(0.8 * t); });
  const ClosureResult result = result_of(record);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].effect, "template zoom");
  // 10 px in two axes, less what the free motions absorb of 64 values: seven or eight patterns.
  EXPECT_NEAR(result.steps[0].parameters.at(0).value, 10.0 / std::sqrt(2.0), 1.0);
  EXPECT_LT(result.steps[0].heldout_after, 1.05 * result.noise_floor);
}

TEST(ObservationCourses, LampsThatBeatWithTheFramesAreNamedWithTheirFrequency) {
  ObservationRecord record = swaying_record(1000, {});
  add_error(record, 0.1, [](double v, double t) {  // the mains wander by 0.02 Hz
    return std::cos(2.0 * kPi * 119.9 * (t + 0.03 * v / 1080.0) + 0.02 * 30.0 * std::cos(2.0 * kPi * t / 30.0));
  });
  const ClosureResult result = result_of(record);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].effect, "flicker");
  EXPECT_NEAR(result.steps[0].parameters.at(0).value, 119.9, 0.01);
  EXPECT_NEAR(result.steps[0].parameters.at(2).value, 0.1 / std::sqrt(2.0), 0.01);
  EXPECT_LT(result.steps[0].heldout_after, 1.05 * result.noise_floor);
}

TEST(ObservationCourses, LampsWhosePhaseSwingsFasterThanTheirBeatIsSoughtLeaveNothing) {
  ObservationRecord record = swaying_record(1000, {});
  add_error(record, 0.3, [](double v, double t) {
    return std::cos(2.0 * kPi * 119.9 * (t + 0.03 * v / 1080.0) + 0.3 * std::cos(2.0 * kPi * 0.3 * t));
  });
  const ClosureResult result = result_of(record);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].effect, "flicker");
  EXPECT_LT(result.steps[0].heldout_after, 1.05 * result.noise_floor);
}

TEST(ObservationCourses, ALineAtAnotherFrequencyIsNoFlicker) {
  ObservationRecord record = swaying_record(1000, {});
  add_error(record, 0.1, [](double, double t) { return std::cos(2.0 * kPi * 7.3 * t); });
  for (const ClosureStep& step : result_of(record).steps) EXPECT_NE(step.effect, "flicker");
}

TEST(ObservationCourses, AVibrationAtTheFrequencyOfLampsIsNoFlicker) {
  ObservationRecord record = swaying_record(1000, {});
  NoiseStream noise(11);
  double position = 0.0, speed = 0.0;
  std::vector<double> course;
  const double w = 2.0 * kPi * 5.1 / record.rate_hz;
  for (Eigen::Index k = 0; k < record.n_frames(); ++k) {  // an oscillator under white noise, damping 0.5 %
    speed += 0.1 * w * noise.gaussian() - w * w * position - 0.01 * w * speed;
    position += speed, course.push_back(position);
  }
  add_error(record, 0.3,
            [&](double, double t) { return course[static_cast<std::size_t>(std::lround(t * record.rate_hz))]; });
  for (const ClosureStep& step : result_of(record).steps) EXPECT_NE(step.effect, "flicker");
}

TEST(CourseFit, ConstantsAreFoundAndNoiseGainsNothing) {
  PointCourses courses{{Eigen::MatrixXd(1, 500)}, {0, 0}};
  NoiseStream noise(5);
  for (double& value : courses.sets[0].reshaped()) value = noise.gaussian();
  courses.sets[0].array() -= courses.sets[0].mean();
  Eigen::MatrixXd residual(4, 500);
  for (double& value : residual.reshaped()) value = noise.gaussian();
  EXPECT_LT(CourseFit(courses, residual).held_out_gain(), 10.0);
  const Eigen::Vector4d truth(1.0, -2.0, 0.0, 3.0);
  const CourseFit fit(courses, residual + truth * courses.sets[0].row(0));
  EXPECT_TRUE(fit.is_usable());
  EXPECT_NEAR(fit.held_out_gain() / (14.0 * courses.sets[0].squaredNorm()), 1.0, 0.1);
  EXPECT_LT((fit.fitted() - truth * courses.sets[0].row(0)).norm() / fit.fitted().norm(), 0.1);
}

TEST(CourseFit, ACourseThatDoesNotMoveIsNotUsable) {
  const PointCourses still{{Eigen::MatrixXd::Zero(1, 500)}, {0, 0}};
  const CourseFit fit(still, Eigen::MatrixXd::Ones(4, 500));
  EXPECT_FALSE(fit.is_usable());
  EXPECT_EQ(fit.held_out_gain(), 0.0);
  EXPECT_TRUE(fit.fitted().isZero());
}

}  // namespace
}  // namespace core::closure
