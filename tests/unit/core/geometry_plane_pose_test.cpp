#include "core/geometry/plane_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace core {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
const CameraModel kCamera{2100.0, 2080.0, 961.5, 542.0, {}};

PlanePose truth(double tilt_x_deg, double tilt_y_deg, double turn_deg, double distance_mm = 3000.0) {
  PlanePose pose;
  pose.camera = kCamera;
  const auto by = [](double deg, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(deg * kRad, axis).toRotationMatrix();
  };
  pose.rotation = by(turn_deg, Eigen::Vector3d::UnitZ()) * by(tilt_y_deg, Eigen::Vector3d::UnitY()) *
                  by(tilt_x_deg, Eigen::Vector3d::UnitX());
  pose.translation_mm = {-120.0, 80.0, distance_mm};
  return pose;
}

std::vector<PlaneCorrespondence> points_of(const PlanePose& pose, const std::vector<PlanePlace>& places,
                                           double noise_px = 0.0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise_px);
  std::vector<PlaneCorrespondence> points;
  for (const PlanePlace& place : places) {
    const Vector2 px = pose.project(place).value();
    points.push_back({{px.u + normal(random), px.v + normal(random)}, place});
  }
  return points;
}

const std::vector<PlanePlace> kFour{{-400.0, -300.0}, {420.0, -280.0}, {390.0, 310.0}, {-410.0, 290.0}};
const std::vector<PlanePlace> kEight{{-400.0, -300.0}, {420.0, -280.0}, {390.0, 310.0}, {-410.0, 290.0},
                                     {10.0, -310.0},   {380.0, 20.0},   {-15.0, 305.0}, {-405.0, -10.0}};

TEST(PlanePose, FindsTheTruthOfExactPoints) {
  for (const double tilt : {0.0, 3.0, 25.0, -50.0}) {
    const PlanePose pose = truth(tilt, 0.6 * tilt, 15.0);
    const PlanePoseFit fit = fit_plane_pose(points_of(pose, kFour), kCamera, 0.5);
    ASSERT_EQ(fit.status, PlaneStatus::kOk) << tilt;
    EXPECT_LT((fit.pose.rotation - pose.rotation).norm(), 1e-7) << tilt;
    EXPECT_LT((fit.pose.translation_mm - pose.translation_mm).norm(), 1e-3) << tilt;
    EXPECT_LT(fit.pose.rms_px, 1e-6);
    EXPECT_NEAR(fit.pose.obliqueness_deg(), std::acos(std::cos(tilt * kRad) * std::cos(0.6 * tilt * kRad)) / kRad,
                1e-5);
  }
}

// Heights measured upwards: the coordinates' orientation is opposite to the image's.
TEST(PlanePose, TakesCoordinatesOfEitherSense) {
  PlanePose pose = truth(20.0, -10.0, 0.0);
  pose.rotation = pose.rotation * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const PlanePoseFit fit = fit_plane_pose(points_of(pose, kEight), kCamera, 0.5);
  ASSERT_EQ(fit.status, PlaneStatus::kOk);
  EXPECT_LT((fit.pose.rotation - pose.rotation).norm(), 1e-7);
  EXPECT_LT(fit.pose.normal().z(), 0.0);  // towards the camera, for either orientation
}

TEST(PlanePose, PointsOfThePlaneAndPixelsAreEachOthersInverse) {
  const PlanePose pose = truth(35.0, -20.0, 30.0);
  for (const PlanePlace& place : kEight) {
    const auto back = pose.place_at(pose.project(place).value());
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->x_mm, place.x_mm, 1e-8);
    EXPECT_NEAR(back->y_mm, place.y_mm, 1e-8);
  }
  const Eigen::Vector3d on_plane = pose.rotation * Eigen::Vector3d(17.0, -40.0, 0.0) + pose.translation_mm;
  EXPECT_NEAR(-pose.normal().dot(on_plane), pose.distance_mm(), 1e-9);
}

TEST(PlanePose, RaysThatMissThePlaneMeetNothing) {
  const PlanePose pose = truth(0.0, 80.0, 0.0);
  int met = 0, missed = 0;
  for (double u = -20000.0; u <= 20000.0; u += 1000.0) ++(pose.place_at({u, 542.0}) ? met : missed);
  EXPECT_GT(met, 5);
  EXPECT_GT(missed, 5);
  EXPECT_FALSE(pose.project({1e7, 0.0}) && pose.project({-1e7, 0.0}));
  EXPECT_FALSE(pose.place_at({std::nan(""), 0.0}));
}

TEST(PlanePose, JacobianIsTheLocalScale) {
  const PlanePose pose = truth(30.0, 10.0, -20.0);
  const PlanePlace at{150.0, -90.0};
  constexpr double kStep = 1e-3;
  const Vector2 right = pose.project({at.x_mm + kStep, at.y_mm}).value();
  const Vector2 left = pose.project({at.x_mm - kStep, at.y_mm}).value();
  const Vector2 down = pose.project({at.x_mm, at.y_mm + kStep}).value();
  const Vector2 up = pose.project({at.x_mm, at.y_mm - kStep}).value();
  const Eigen::Matrix2d j = pose.px_per_mm(at);
  EXPECT_NEAR(j(0, 0), (right.u - left.u) / (2 * kStep), 1e-6);
  EXPECT_NEAR(j(1, 0), (right.v - left.v) / (2 * kStep), 1e-6);
  EXPECT_NEAR(j(0, 1), (down.u - up.u) / (2 * kStep), 1e-6);
  EXPECT_NEAR(j(1, 1), (down.v - up.v) / (2 * kStep), 1e-6);
  const Vector2 px = pose.project(at).value();
  const PlanePlace next = pose.place_at({px.u + 1e-3 * 0.6, px.v + 1e-3 * 0.8}).value();
  EXPECT_NEAR(pose.mm_per_px(at, {0.6, 0.8}), std::hypot(next.x_mm - at.x_mm, next.y_mm - at.y_mm) / 1e-3, 1e-5);
}

TEST(PlanePose, StraightOnTheScaleIsDepthOverFocalLength) {
  const PlanePose pose = truth(0.0, 0.0, 0.0);
  EXPECT_NEAR(pose.mm_per_px({200.0, 100.0}, {1.0, 0.0}), 3000.0 / 2100.0, 1e-12);
  EXPECT_NEAR(pose.mm_per_px({200.0, 100.0}, {0.0, 1.0}), 3000.0 / 2080.0, 1e-12);
}

// Six parameters and the obliqueness, 200 draws: mean square error over the stated variance.
TEST(PlanePose, StatesItsErrors) {
  constexpr double kNoisePx = 0.5;
  constexpr int kDraws = 200;
  const PlanePose pose = truth(25.0, -15.0, 5.0, 2000.0);
  Eigen::Matrix<double, 6, 1> ratio = Eigen::Matrix<double, 6, 1>::Zero();
  double obliqueness = 0.0, all = 0.0;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    const PlanePoseFit fit = fit_plane_pose(points_of(pose, kEight, kNoisePx, seed), kCamera, kNoisePx);
    ASSERT_EQ(fit.status, PlaneStatus::kOk);
    const Eigen::AngleAxisd turn(pose.rotation * fit.pose.rotation.transpose());
    Eigen::Matrix<double, 6, 1> error;
    error << turn.angle() * turn.axis(), pose.translation_mm - fit.pose.translation_mm;
    ratio += error.cwiseAbs2().cwiseQuotient(fit.pose.covariance.diagonal()) / kDraws;
    all += error.dot(fit.pose.covariance.ldlt().solve(error)) / (6.0 * kDraws);
    obliqueness +=
        std::pow((fit.pose.obliqueness_deg() - pose.obliqueness_deg()) / fit.pose.obliqueness_sigma_deg(), 2) / kDraws;
  }
  // The covariance uses the larger of stated and observed residual, which makes it about a tenth too large.
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(ratio(i), 0.9, 0.35) << i;
  EXPECT_NEAR(all, 0.9, 0.2);
  EXPECT_NEAR(obliqueness, 0.9, 0.35);
}

TEST(PlanePose, FromAfarTheOtherTiltIsReported) {
  const CameraModel tele{20000.0, 20000.0, 960.0, 540.0, {}};
  PlanePose far = truth(12.0, 8.0, 0.0, 60000.0);
  far.camera = tele;
  const PlanePoseFit open = fit_plane_pose(points_of(far, kFour, 0.5), tele, 0.5);
  ASSERT_EQ(open.status, PlaneStatus::kOk);
  ASSERT_TRUE(open.other);
  EXPECT_GE(open.other->chi_square, open.pose.chi_square);
  const Eigen::Vector3d a = open.pose.normal(), b = open.other->normal();
  EXPECT_LT(a.x() * b.x() + a.y() * b.y(), 0.0);  // inclined in the other direction
  const PlanePoseFit near = fit_plane_pose(points_of(truth(25.0, -15.0, 0.0, 1500.0), kFour, 0.5), kCamera, 0.5);
  EXPECT_FALSE(near.other);
}

TEST(PlanePose, RefusesWhatDeterminesNoPlane) {
  const PlanePose pose = truth(20.0, 10.0, 0.0);
  const auto status = [&](const std::vector<PlanePlace>& places) {
    return fit_plane_pose(points_of(pose, places), kCamera, 0.5).status;
  };
  EXPECT_EQ(status({kFour[0], kFour[1], kFour[2]}), PlaneStatus::kTooFew);
  EXPECT_EQ(status({{0.0, 0.0}, {100.0, 50.0}, {200.0, 100.0}, {300.0, 150.0}}), PlaneStatus::kCollinear);
  EXPECT_EQ(status({{0.0, 0.0}, {100.0, 0.0}, {200.0, 0.0}, {50.0, 300.0}}), PlaneStatus::kCollinear);  // three of four
  EXPECT_EQ(status({kFour[0], kFour[0], kFour[0], kFour[0]}), PlaneStatus::kCollinear);
  EXPECT_EQ(status({kFour[0], kFour[1], kFour[2], kFour[0]}), PlaneStatus::kCollinear);  // one given twice
  EXPECT_EQ(fit_plane_pose(points_of(pose, kFour), CameraModel{}, 0.5).status, PlaneStatus::kNotCalibrated);
  auto broken = points_of(pose, kFour);
  broken[2].ideal_px.v = std::nan("");
  EXPECT_EQ(fit_plane_pose(broken, kCamera, 0.5).status, PlaneStatus::kNoFit);
}

TEST(PlanePose, PointsThatContradictEachOtherShowInTheResidual) {
  auto points = points_of(truth(20.0, 10.0, 0.0), kEight);
  std::swap(points[4].place, points[6].place);
  const PlanePoseFit fit = fit_plane_pose(points, kCamera, 0.5);
  EXPECT_TRUE(fit.status == PlaneStatus::kNoFit || fit.pose.rms_px > 20.0);
}

}  // namespace
}  // namespace core
