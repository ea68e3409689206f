#include "core/geometry/camera_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace core {

namespace {

constexpr int n = kMotionSize;
// Corner frequency of the motion of an aircraft in position hold (satellite and vision) and of its gimbal.
constexpr double kCorner_hz = 0.5;
// Initial standard deviations and the limits of learning. Translations: as shares of the distance to the structure.
constexpr double kTurn_rad = 0.035, kLeastTurn_rad = 1e-6, kMostTurn_rad = 0.2;
constexpr double kShift = 0.03, kLeastShift = 1e-6, kMostShift = 0.2;
// Almost free perspective rotation: see the header.
constexpr double kFace_rad = 1.0;
constexpr int kIterations = 3;
// Learning of the prior's variances: rate per frame; decay towards zero motion, which only clear motion counteracts;
// largest update by one frame; and the update above which the prior is obviously too narrow.
constexpr double kLearningRate = 0.1, kTowardsRest = 0.02, kMostSurprise = 4.0, kPlainSurprise = 16.0;
constexpr double kLeastShare = 0.05;  // smallest share of a component's variance that this frame must reduce
constexpr double kOpen_px = 0.5;
// A translation is dropped if its uncertainty from one frame moves a channel by this multiple of the channel's own
// sigma.
constexpr double kPoorlyTold = 10.0;

}  // namespace

CameraMotionEstimator::CameraMotionEstimator(const CameraMotionConfig& config, const std::vector<KeyframePoint>& points,
                                             const std::vector<KeyframeRegion>& regions, double t_keyframe_s)
    : config_(config),
      process_(kCorner_hz),
      before_(kCorner_hz),
      settled_(kCorner_hz),
      t_s_(t_keyframe_s),
      equations_(config.fx, config.fy, config.readout_s, mean_share(points), regions.size()) {
  MotionKeyframe keyframe = motion_keyframe(points, regions, config.distance_mm);
  points_ = std::move(keyframe.points), regions_ = std::move(keyframe.regions), middle_ = keyframe.middle;
  rests_ = std::any_of(regions.begin(), regions.end(),
                       [](const KeyframeRegion& region) { return region.kind != KeyframeRegion::Kind::kMoving; });
  const double d = config.distance_mm;
  base_ << 1.0, 1.0, 1.0, d, d, d, kFace_rad, kFace_rad;
  log_variance_ = {2.0 * std::log(kTurn_rad), 2.0 * std::log(kShift)};
  set_sd();
  process_.start(sd_);
}

double CameraMotionEstimator::mean_share(const std::vector<KeyframePoint>& points) noexcept {
  double sum = 0.0;
  for (const KeyframePoint& point : points) sum += point.readout_share;
  return points.empty() ? 0.0 : sum / static_cast<double>(points.size());
}

void CameraMotionEstimator::set_sd() noexcept {
  log_variance_[0] = std::clamp(log_variance_[0], 2.0 * std::log(kLeastTurn_rad), 2.0 * std::log(kMostTurn_rad));
  log_variance_[1] = std::clamp(log_variance_[1], 2.0 * std::log(kLeastShift), 2.0 * std::log(kMostShift));
  sd_ = base_;
  sd_.segment<3>(kPitch) *= std::exp(0.5 * log_variance_[0]);
  sd_.segment<3>(kShiftX) *= std::exp(0.5 * log_variance_[1]);
}

void CameraMotionEstimator::predict(double t_s) noexcept {
  raised_ = false;
  settled_ = process_;
  dt_s_ = std::max(0.0, t_s - t_s_);
  t_s_ += dt_s_;
  before_ = settled_;
  before_.predict(dt_s_, sd_);
  process_ = before_;
  taken_ = process_.mean();
}

// Time derivatives are taken at their current estimates and not fitted: rows would determine them, too, but an error of
// the readout time, and motion during the readout of the keyframe, would be mistaken for them.
void CameraMotionEstimator::iterate(const MotionObservation& seen) noexcept {
  process_ = before_;
  MotionStateVector linear = before_.mean(), step = MotionStateVector::Zero();
  for (int pass = 0; pass < kIterations; ++pass) {
    equations_.build(linear, points_, regions_, seen, pass > 0);
    const MotionVector ahead = (linear - before_.mean()).head<n>();
    information_ = equations_.information();
    MotionVector gradient = equations_.gradient();
    add_turn(linear, gradient);
    if (!process_.step(information_, gradient + information_ * ahead, step)) {
      ++n_failed_;
      process_ = before_;
      taken_ = process_.mean();
      return;
    }
    equations_.update_own(step.head<n>() - ahead, regions_);
    linear = before_.mean() + step;
  }
  process_.accept(step);
  taken_ = process_.mean();
}

void CameraMotionEstimator::add_turn(const MotionStateVector& linear, MotionVector& gradient) noexcept {
  if (!turn_) return;
  const double weight = 1.0 / (turn_->sigma_rad * turn_->sigma_rad);
  information_.diagonal().segment<3>(kPitch).array() += weight;
  gradient.segment<3>(kPitch) += weight * (turn_->turn_rad - linear.segment<3>(kPitch));
}

void CameraMotionEstimator::correct(const MotionObservation& seen) noexcept {
  iterate(seen);
  if (raised_ || !surprised()) return;
  raised_ = true;
  set_sd();
  before_ = settled_;
  before_.predict(dt_s_, sd_);
  iterate(seen);
}

// If a group of components moved far beyond its prior, the prior is widened at once.
bool CameraMotionEstimator::surprised() noexcept {
  bool any = false;
  for (std::size_t g = 0; g < log_variance_.size(); ++g) {
    double most = 0.0;
    for (int i = static_cast<int>(3 * g); i < static_cast<int>(3 * g) + 3; ++i) {
      const double prior = before_.covariance()(i, i), gained = prior - process_.covariance()(i, i);
      const double moved = process_.mean()(i) - before_.mean()(i);
      if (gained > kLeastShare * prior) most = std::max(most, moved * moved / gained);
    }
    if (!(most > kPlainSurprise)) continue;
    log_variance_[g] += std::log(most);
    any = true;
  }
  return any;
}

// One ascent step of the likelihood of the group's variance: actual against expected correction of each component.
void CameraMotionEstimator::learn() noexcept {
  for (std::size_t g = 0; g < log_variance_.size(); ++g) {
    double sum = 0.0, count = 0.0;
    for (int i = static_cast<int>(3 * g); i < static_cast<int>(3 * g) + 3; ++i) {
      const double prior = before_.covariance()(i, i), gained = prior - process_.covariance()(i, i);
      if (!(prior > 0.0) || !(gained > 0.0)) continue;
      const double moved = process_.mean()(i) - before_.mean()(i);
      sum += gained / prior * (std::min(moved * moved / gained, kMostSurprise) - 1.0);
      count += 1.0;
    }
    if (count > 0.0) log_variance_[g] += kLearningRate * (sum / count - kTowardsRest);
  }
}

bool CameraMotionEstimator::settle() noexcept {
  position_covariance_ = process_.covariance().topLeftCorner<n, n>();
  open_.fill(false);
  const bool left_out = leave_out_poorly_told();
  find_open();
  learn();
  set_sd();
  return left_out;
}

// Largest effect along an axis of the region.
double CameraMotionEstimator::effect_px(const MotionVector& motion, std::size_t r) const noexcept {
  const MotionRegion& region = regions_[r];
  const Eigen::Vector2d px = region.effect * motion;
  double most = 0.0;
  for (int a = 0; a < region.about.n_axes; ++a) {
    most = std::max(most, std::abs(region.about.axis[static_cast<std::size_t>(a)].head<2>().dot(px)));
  }
  return region.about.kind == KeyframeRegion::Kind::kMoving ? most : 0.0;
}

// Conditions the covariance of the other components on this one.
void CameraMotionEstimator::give_up(int component) noexcept {
  open_[static_cast<std::size_t>(component)] = true;
  const MotionVector column = position_covariance_.col(component);
  if (column(component) > 0.0) position_covariance_ -= column * column.transpose() / column(component);
  position_covariance_.row(component).setZero();
  position_covariance_.col(component).setZero();
}

// The data of this frame (with the prior's size) do not determine a translation and the components correlated with it:
// the direction `along`. The state is moved along it to zero translation, where it fits the frame equally well.
bool CameraMotionEstimator::leave_out_poorly_told() noexcept {
  const auto scale = sd_.asDiagonal();
  MotionMatrix scaled = scale * information_ * scale;
  scaled.diagonal().array() += 1.0;
  MotionMatrix frame = scale * scaled.llt().solve(MotionMatrix(scale));
  bool any = false;
  for (int round = 0; round < 2; ++round) {
    int worst = -1;
    double most = kPoorlyTold;
    for (const int i : {int{kShiftX}, int{kShiftY}}) {
      if (open_[static_cast<std::size_t>(i)] || !(frame(i, i) > 0.0)) continue;
      const MotionVector along = frame.col(i) / std::sqrt(frame(i, i));
      for (std::size_t r = 0; r < regions_.size(); ++r) {
        const double ratio = effect_px(along, r) * std::sqrt(regions_[r].sum_weight);
        if (ratio > most) worst = i, most = ratio;
      }
    }
    if (worst < 0) break;
    any = true;
    const MotionVector along = frame.col(worst) / frame(worst, worst);
    for (int d = 0; d < 3; ++d) taken_.segment<n>(d * n) -= taken_(d * n + worst) * along;
    frame -= frame(worst, worst) * (along * along.transpose());
    give_up(worst);
  }
  return any;
}

// Repeatedly takes the component with the largest uncertainty, in px at the channels, as given, and updates the others.
void CameraMotionEstimator::find_open() noexcept {
  for (int round = 0; round < n; ++round) {
    int worst = -1;
    double worst_px = kOpen_px;
    for (int i = 0; i < n; ++i) {
      const double sd = std::sqrt(std::max(0.0, position_covariance_(i, i)));
      for (std::size_t r = 0; r < regions_.size(); ++r) {
        const double px = effect_px(sd * MotionVector::Unit(i), r);
        if (px > worst_px) worst = i, worst_px = px;
      }
    }
    if (worst < 0) return;
    give_up(worst);
  }
}

double CameraMotionEstimator::sigma_px(std::size_t region, double e_u, double e_v) const noexcept {
  const MotionVector effect = (Eigen::RowVector2d(e_u, e_v) * regions_[region].effect).transpose();
  return std::sqrt(std::max(0.0, effect.dot(position_covariance_ * effect)));
}

// Intersects the point's ray in this frame, in keyframe axes, with the point's plane.
Vector2 CameraMotionEstimator::stabilised(std::size_t i, const Vector2& position, double share) const noexcept {
  const MotionPoint& point = points_[i];
  const MotionPose pose = equations_.pose(taken_, share);
  const Eigen::Vector3d seen(position.u / config_.fx, position.v / config_.fy, 1.0);
  // seen ~ R(w) [c + R(f) (x)] up to a factor; x: position of the point relative to c in the keyframe's axes.
  const Eigen::Vector3d direction = pose.face.transpose() * (pose.turn.transpose() * seen);
  const Eigen::Vector3d origin = point.inverse_depth * pose.shift + pose.face.transpose() * point.middle;
  const Eigen::Vector3d rest = point.ray - point.middle;
  const MotionRegion& region = regions_[point.region];
  const Eigen::Vector3d& normal = region.about.normal;
  Eigen::Vector3d moved = direction * (normal.dot(rest + origin) / normal.dot(direction)) - origin - rest;
  // A far point is static: its zoom is camera motion, too.
  if (region.about.kind == KeyframeRegion::Kind::kFar) moved -= point.own * region.value;
  const double z = 1.0 + moved.z();
  return {config_.fx * ((point.ray.x() + moved.x()) / z - point.ray.x()),
          config_.fy * ((point.ray.y() + moved.y()) / z - point.ray.y())};
}

double CameraMotionEstimator::magnification() const noexcept {
  const MotionPose pose(taken_.head<n>());
  return 1.0 / (pose.turn * (middle_ + pose.face * pose.shift / config_.distance_mm)).z();
}

}  // namespace core
