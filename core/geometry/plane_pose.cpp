#include "core/geometry/plane_pose.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/linear/damped_least_squares.h"
#include "core/types/constants.h"

namespace core {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kThinnest = 1e-3;      // width over length of the points: below, they count as collinear
constexpr double kNotMuchWorse = 11.8;  // difference in chi square
constexpr double kSamePoseRad = 1e-3;

Vector3d in_camera(const PlanePose& pose, const PlanePlace& place) {
  return pose.rotation.col(0) * place.x_mm + pose.rotation.col(1) * place.y_mm + pose.translation_mm;
}

// Translation and scale that give the points zero mean and unit spread; without them the homography is ill-conditioned
// (Hartley 1997).
struct Normaliser {
  double x = 0.0, y = 0.0, scale = 1.0;
  [[nodiscard]] Matrix3d matrix() const {
    Matrix3d m;
    m << scale, 0.0, -scale * x, 0.0, scale, -scale * y, 0.0, 0.0, 1.0;
    return m;
  }
};

struct Spread {
  Normaliser normaliser;
  double thinness = 0.0;  // 0 = collinear
};

Spread spread_of(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const auto& p : points) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::Vector2d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvalues();
  Spread out;
  if (!(values(1) > 0.0)) return out;
  out.thinness = std::sqrt(std::max(0.0, values(0)) / values(1));
  out.normaliser = {mean.x(), mean.y(), std::sqrt(static_cast<double>(points.size()) / scatter.trace())};
  return out;
}

struct Prepared {
  std::vector<Eigen::Vector2d> rays, places;  // normalised image coordinates; mm
  Spread image, plane;
};

Prepared prepare(std::span<const PlaneCorrespondence> points, const CameraModel& camera) {
  Prepared out;
  for (const PlaneCorrespondence& p : points) {
    out.rays.emplace_back((p.ideal_px.u - camera.cx) / camera.fx, (p.ideal_px.v - camera.cy) / camera.fy);
    out.places.emplace_back(p.place.x_mm, p.place.y_mm);
  }
  out.image = spread_of(out.rays);
  out.plane = spread_of(out.places);
  return out;
}

// mm -> normalised image coordinates; false if the points do not determine it (three of four on a line).
bool homography(const Prepared& points, Matrix3d& h) {
  const auto n = static_cast<Eigen::Index>(points.rays.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n, 9);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vector3d from = points.plane.normaliser.matrix() * points.places[k].homogeneous();
    const Vector3d to = points.image.normaliser.matrix() * points.rays[k].homogeneous();
    a.row(2 * i) << from.transpose(), 0.0, 0.0, 0.0, -to.x() * from.transpose();
    a.row(2 * i + 1) << 0.0, 0.0, 0.0, from.transpose(), -to.y() * from.transpose();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullV);
  if (!(svd.singularValues()(7) > 1e-6 * svd.singularValues()(0))) return false;
  const Eigen::VectorXd v = svd.matrixV().col(8);
  Matrix3d normalised;
  normalised << v(0), v(1), v(2), v(3), v(4), v(5), v(6), v(7), v(8);
  h = points.image.normaliser.matrix().inverse() * normalised * points.plane.normaliser.matrix();
  return h.allFinite();
}

Matrix3d nearest_rotation(const Vector3d& x, const Vector3d& y) {
  Matrix3d m;
  m << x, y, x.cross(y);
  const Eigen::JacobiSVD<Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d r = svd.matrixU() * svd.matrixV().transpose();
  if (r.determinant() < 0.0) r = svd.matrixU() * Vector3d(1.0, 1.0, -1.0).asDiagonal() * svd.matrixV().transpose();
  return r;
}

// Normal equations of the reprojection error in px, for a rotation w about the camera's axes and a translation t.
struct Equations {
  Matrix6 hessian = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double cost = 0.0;
  bool in_front = true;
};

Equations equations(const PlanePose& pose, std::span<const PlaneCorrespondence> points) {
  Equations out;
  for (const PlaneCorrespondence& point : points) {
    const Vector3d p = in_camera(pose, point.place);
    if (!(p.z() > 0.0)) {
      out.in_front = false;
      return out;
    }
    const Vector3d turned = p - pose.translation_mm;
    const double x = p.x() / p.z();
    const double y = p.y() / p.z();
    Eigen::Matrix<double, 2, 3> by_point;
    by_point << pose.camera.fx / p.z(), 0.0, -pose.camera.fx * x / p.z(), 0.0, pose.camera.fy / p.z(),
        -pose.camera.fy * y / p.z();
    Eigen::Matrix<double, 2, 6> j;
    for (int i = 0; i < 3; ++i) j.col(i) = by_point * Vector3d::Unit(i).cross(turned);
    j.rightCols<3>() = by_point;
    const Eigen::Vector2d r(point.ideal_px.u - pose.camera.cx - pose.camera.fx * x,
                            point.ideal_px.v - pose.camera.cy - pose.camera.fy * y);
    out.hessian += j.transpose() * j;
    out.gradient -= j.transpose() * r;
    out.cost += r.squaredNorm();
  }
  return out;
}

PlanePose moved(PlanePose pose, const Vector6& step) {
  const Vector3d w = step.head<3>();
  if (w.norm() > 0.0) pose.rotation = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix() * pose.rotation;
  pose.translation_mm += step.tail<3>();
  return pose;
}

// Levenberg-Marquardt, because plain Gauss-Newton may jump to the other solution.
bool refine(PlanePose& pose, std::span<const PlaneCorrespondence> points, double sigma_px) {
  constexpr int kSteps = 100;
  Damping damping{.value = 1e-4, .least = 1e-12, .most = 1e12};
  Equations now = equations(pose, points);
  if (!now.in_front || !std::isfinite(now.cost)) return false;
  for (int i = 0; i < kSteps; ++i) {
    const Equations before = now;
    const bool went = damped_step(before.hessian, before.gradient, damping, [&](const Vector6& step) {
      const PlanePose next_pose = moved(pose, step);
      const Equations next = equations(next_pose, points);
      if (!next.in_front || !(next.cost <= now.cost)) return false;
      pose = next_pose;
      now = next;
      return true;
    });
    if (!went || before.cost - now.cost <= 1e-12 * before.cost) break;
  }
  const auto n = static_cast<double>(points.size());
  pose.rms_px = std::sqrt(now.cost / n);
  pose.chi_square = now.cost / (sigma_px * sigma_px);
  const double n_free = 2.0 * n - 6.0;
  const double variance = sigma_px * sigma_px * std::max(1.0, pose.chi_square / n_free);
  pose.covariance = variance * now.hessian.inverse();
  return pose.covariance.allFinite();
}

// The plane with the same image from infinitely far: depths mirrored about the points' centre.
PlanePose turned_round(const PlanePose& pose, const PlanePlace& middle) {
  const Vector3d centre = in_camera(pose, middle);
  const Vector3d sight = centre.normalized();
  const auto mirrored = [&sight](const Vector3d& v) -> Vector3d { return v - 2.0 * sight.dot(v) * sight; };
  PlanePose out = pose;
  out.rotation.col(0) = mirrored(pose.rotation.col(0));
  out.rotation.col(1) = mirrored(pose.rotation.col(1));
  out.rotation.col(2) = out.rotation.col(0).cross(out.rotation.col(1));
  out.translation_mm = centre - out.rotation.col(0) * middle.x_mm - out.rotation.col(1) * middle.y_mm;
  return out;
}

double angle_between(const PlanePose& a, const PlanePose& b) {
  return std::acos(std::clamp(a.normal().dot(b.normal()), -1.0, 1.0));
}

}  // namespace

std::optional<Vector2> PlanePose::project(const PlanePlace& place) const noexcept {
  const Vector3d p = in_camera(*this, place);
  if (!(p.z() > 0.0)) return std::nullopt;
  return Vector2{camera.cx + camera.fx * p.x() / p.z(), camera.cy + camera.fy * p.y() / p.z()};
}

std::optional<PlanePlace> PlanePose::place_at(const Vector2& ideal_px) const noexcept {
  const Vector3d ray((ideal_px.u - camera.cx) / camera.fx, (ideal_px.v - camera.cy) / camera.fy, 1.0);
  const double depth = rotation.col(2).dot(translation_mm) / rotation.col(2).dot(ray);
  if (!(depth > 0.0) || !std::isfinite(depth)) return std::nullopt;
  const Vector3d from_origin = depth * ray - translation_mm;
  return PlanePlace{rotation.col(0).dot(from_origin), rotation.col(1).dot(from_origin)};
}

Vector3d PlanePose::normal() const noexcept {
  const Vector3d n = rotation.col(2);
  return n.dot(translation_mm) > 0.0 ? Vector3d(-n) : n;
}

double PlanePose::distance_mm() const noexcept { return std::abs(rotation.col(2).dot(translation_mm)); }

Eigen::Matrix2d PlanePose::px_per_mm(const PlanePlace& place) const noexcept {
  const Vector3d p = in_camera(*this, place);
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << camera.fx / p.z(), 0.0, -camera.fx * p.x() / (p.z() * p.z()), 0.0, camera.fy / p.z(),
      -camera.fy * p.y() / (p.z() * p.z());
  return by_point * rotation.leftCols<2>();
}

double PlanePose::mm_per_px(const PlanePlace& place, const Vector2& direction) const noexcept {
  return (px_per_mm(place).inverse() * Eigen::Vector2d(direction.u, direction.v)).norm();
}

double PlanePose::obliqueness_deg() const noexcept {
  const Vector3d n = normal();
  return std::atan2(std::hypot(n.x(), n.y()), std::abs(n.z())) * kDegPerRad;
}

// A rotation w changes the normal by w x n; the angle changes by the component along the direction of tilt.
double PlanePose::obliqueness_sigma_deg() const noexcept {
  const Vector3d n = normal();
  const double lean = std::hypot(n.x(), n.y());
  const Eigen::Matrix2d turn = covariance.topLeftCorner<2, 2>();
  const double least_certain = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(turn).eigenvalues()(1));
  if (!(lean > least_certain)) return least_certain * kDegPerRad;
  const Eigen::Vector2d across(n.y() / lean, -n.x() / lean);
  return std::sqrt(across.dot(turn * across)) * kDegPerRad;
}

PlanePoseFit fit_plane_pose(std::span<const PlaneCorrespondence> points, const CameraModel& camera, double sigma_px) {
  PlanePoseFit out;
  const auto refused = [&out](PlaneStatus status) {
    out.status = status;
    return out;
  };
  if (!camera.calibrated()) return refused(PlaneStatus::kNotCalibrated);
  if (points.size() < 4) return refused(PlaneStatus::kTooFew);
  const Prepared prepared = prepare(points, camera);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!prepared.rays[i].allFinite() || !prepared.places[i].allFinite()) return refused(PlaneStatus::kNoFit);
  }
  Matrix3d h;
  if (!(std::min(prepared.image.thinness, prepared.plane.thinness) > kThinnest) || !homography(prepared, h))
    return refused(PlaneStatus::kCollinear);
  const PlanePlace middle{prepared.plane.normaliser.x, prepared.plane.normaliser.y};
  h *= 2.0 / (h.col(0).norm() + h.col(1).norm());
  if ((h * Vector3d(middle.x_mm, middle.y_mm, 1.0)).z() < 0.0) h = -h;
  out.pose.camera = camera;
  out.pose.rotation = nearest_rotation(h.col(0), h.col(1));
  out.pose.translation_mm =
      h * Vector3d(middle.x_mm, middle.y_mm, 1.0) - out.pose.rotation * Vector3d(middle.x_mm, middle.y_mm, 0.0);
  PlanePose other = turned_round(out.pose, middle);
  const bool found = refine(out.pose, points, sigma_px);
  const bool other_found = refine(other, points, sigma_px);
  if (!found && !other_found) return refused(PlaneStatus::kNoFit);
  if (!found || (other_found && other.chi_square < out.pose.chi_square)) std::swap(out.pose, other);
  out.status = PlaneStatus::kOk;
  const double n_free = 2.0 * static_cast<double>(points.size()) - 6.0;
  const double excess = (other.chi_square - out.pose.chi_square) / std::max(1.0, out.pose.chi_square / n_free);
  if (found && other_found && excess < kNotMuchWorse && angle_between(out.pose, other) > kSamePoseRad)
    out.other = other;
  return out;
}

}  // namespace core
