#include "core/linear/damped_least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>

namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// Rosenbrock's valley as residuals: minimum 0 at (1, 1).
Vector2d residual(const Vector2d& p) { return {10.0 * (p.y() - p.x() * p.x()), 1.0 - p.x()}; }

TEST(DampedStep, ReachesTheMinimumOfACurvedValleyAndNeverRises) {
  Vector2d p(-1.2, 1.0);
  core::Damping damping;
  double cost = residual(p).squaredNorm();
  for (int i = 0; i < 100 && cost > 1e-24; ++i) {
    Matrix2d j;
    j << -20.0 * p.x(), 10.0, -1.0, 0.0;
    const Matrix2d hessian = j.transpose() * j;
    const Vector2d gradient = j.transpose() * residual(p);
    const double before = cost;
    if (!core::damped_step(hessian, gradient, damping, [&](const Vector2d& step) {
          const double there = residual(p + step).squaredNorm();
          if (!(there < cost)) return false;
          p += step, cost = there;
          return true;
        })) {
      break;
    }
    EXPECT_LT(cost, before);
  }
  EXPECT_NEAR(p.x(), 1.0, 1e-9);
  EXPECT_NEAR(p.y(), 1.0, 1e-9);
}

// (H + damping diag H) step = -gradient, by hand; accepted at once, the damping falls to a tenth, but not below its
// least.
TEST(DampedStep, SolvesTheDampedNormalEquations) {
  MatrixXd hessian(2, 2);
  hessian << 4.0, 1.0, 1.0, 2.0;
  const VectorXd gradient = Vector2d(1.0, -3.0);
  core::Damping damping{.value = 0.5, .least = 0.1};
  VectorXd taken;
  ASSERT_TRUE(core::damped_step(hessian, gradient, damping, [&](const VectorXd& step) {
    taken = step;
    return true;
  }));
  EXPECT_NEAR(6.0 * taken(0) + 1.0 * taken(1), -1.0, 1e-12);
  EXPECT_NEAR(1.0 * taken(0) + 3.0 * taken(1), 3.0, 1e-12);
  EXPECT_DOUBLE_EQ(damping.value, 0.1);
}

TEST(DampedStep, ShortensTheStepUntilItIsAcceptedOrGivesUp) {
  const Matrix2d hessian = Matrix2d::Identity();
  const Vector2d gradient(1.0, 0.0);
  core::Damping damping;
  EXPECT_TRUE(core::damped_step(hessian, gradient, damping, [](const Vector2d& step) { return step.norm() < 0.02; }));
  EXPECT_NEAR(damping.value, 10.0, 1e-9) << "accepted at 100";
  damping = {};
  int n_tried = 0;
  EXPECT_FALSE(core::damped_step(hessian, gradient, damping, [&](const Vector2d&) { return ++n_tried < 0; }));
  EXPECT_EQ(n_tried, 9) << "1e-3 ... 1e5";
}

TEST(DampedStep, OffersNoStepThatIsNotFinite) {
  const Vector2d gradient(std::numeric_limits<double>::quiet_NaN(), 0.0);
  core::Damping damping;
  int n_tried = 0;
  EXPECT_FALSE(core::damped_step(Matrix2d(Matrix2d::Identity()), gradient, damping,
                                 [&](const Vector2d&) { return ++n_tried > 0; }));
  EXPECT_EQ(n_tried, 0);
}

}  // namespace
