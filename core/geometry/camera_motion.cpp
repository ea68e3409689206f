#include "core/geometry/camera_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace core {

namespace {

constexpr int n = kMotionSize;
// An aircraft that holds its place by satellite and vision, and its gimbal, move below about this.
constexpr double kCorner_hz = 0.5;
// Standard deviations to begin with, and what learning keeps to. Shifts: shares of the distance to the structure.
constexpr double kTurn_rad = 0.035, kLeastTurn_rad = 1e-6, kMostTurn_rad = 0.2;
constexpr double kShift = 0.03, kLeastShift = 1e-6, kMostShift = 0.2;
// The perspective turn is as good as free: see the header.
constexpr double kFace_rad = 1.0;
constexpr int kIterations = 3;
// Learning: rate per frame; pull towards rest, which nothing but motion that is clearly there withstands; what a single
// frame may say; and where the prior is plainly too narrow.
constexpr double kLearningRate = 0.1, kTowardsRest = 0.02, kMostSurprise = 4.0, kPlainSurprise = 16.0;
constexpr double kLeastShare = 0.05;  // of its variance that a component has from this frame, to be asked
constexpr double kOpen_px = 0.5;
// A shift that a frame tells this many times worse than a channel's own points tell where the channel is.
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

// The derivatives by time enter as what they are now estimated to be: rows tell them too, but a wrong readout time, and
// what moved while the keyframe itself was read, would pass for them.
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

// A group of components that moved by far more than its prior lets it: the prior is widened at once.
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

// One step up the likelihood of the group's variance: each component's correction against what the filter expects.
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

// Greatest effect along an axis of the region.
double CameraMotionEstimator::effect_px(const MotionVector& motion, std::size_t r) const noexcept {
  const MotionRegion& region = regions_[r];
  const Eigen::Vector2d px = region.effect * motion;
  double most = 0.0;
  for (int a = 0; a < region.about.n_axes; ++a) {
    most = std::max(most, std::abs(region.about.axis[static_cast<std::size_t>(a)].head<2>().dot(px)));
  }
  return region.about.kind == KeyframeRegion::Kind::kMoving ? most : 0.0;
}

// What is known of the others, this one given.
void CameraMotionEstimator::give_up(int component) noexcept {
  open_[static_cast<std::size_t>(component)] = true;
  const MotionVector column = position_covariance_.col(component);
  if (column(component) > 0.0) position_covariance_ -= column * column.transpose() / column(component);
  position_covariance_.row(component).setZero();
  position_covariance_.col(component).setZero();
}

// This frame alone (and the prior's size) leaves a shift and what goes with it the direction `along`: the state is
// moved along it to where the shift is zero, and fits the frame as before.
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

// From the component that is known worst, in px at the channels: what is open is taken as given, the rest judged again.
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

// The point's ray of this frame in keyframe axes, up to the point's plane.
Vector2 CameraMotionEstimator::stabilised(std::size_t i, const Vector2& position, double share) const noexcept {
  const MotionPoint& point = points_[i];
  const MotionPose pose = equations_.pose(taken_, share);
  const Eigen::Vector3d seen(position.u / config_.fx, position.v / config_.fy, 1.0);
  // seen ~ R(w) [c + R(f) (x)], x = where the point is now in the keyframe's axes, from c, up to a factor.
  const Eigen::Vector3d direction = pose.face.transpose() * (pose.turn.transpose() * seen);
  const Eigen::Vector3d origin = point.inverse_depth * pose.shift + pose.face.transpose() * point.middle;
  const Eigen::Vector3d rest = point.ray - point.middle;
  const MotionRegion& region = regions_[point.region];
  const Eigen::Vector3d& normal = region.about.normal;
  Eigen::Vector3d moved = direction * (normal.dot(rest + origin) / normal.dot(direction)) - origin - rest;
  // What is far rests: its zoom is the camera's too.
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
