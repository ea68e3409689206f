#include "core/geometry/camera_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

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
// The regions' own motions, in every frame: shares of the distance, rad, relative zoom.
constexpr double kSlide = 1e3, kSlidePerReadout = 10.0, kZoom = 0.2, kFarShift = 0.5;
constexpr int kIterations = 3;
// Learning: rate per frame; pull towards rest, which nothing but motion that is clearly there withstands; what a single
// frame may say; and where the prior is plainly too narrow.
constexpr double kLearningRate = 0.1, kTowardsRest = 0.02, kMostSurprise = 4.0, kPlainSurprise = 16.0;
constexpr double kLeastShare = 0.05;  // of its variance that a component has from this frame, to be asked
constexpr double kTiltRate = 0.02, kLeastTilt_rad = 1e-6;
constexpr double kOpen_px = 0.5;

// What it takes for a turn of the region in its plane to be told from its slide.
constexpr std::uint32_t kPointsForTilt = 4;

}  // namespace

CameraMotion::CameraMotion(const CameraMotionConfig& config, const std::vector<KeyframePoint>& points,
                           const std::vector<KeyframeRegion>& regions, double t_keyframe_s)
    : config_(config),
      process_(kCorner_hz),
      before_(kCorner_hz),
      settled_(kCorner_hz),
      t_s_(t_keyframe_s),
      equations_(config.fx, config.fy, config.readout_s, mean_share(points), regions.size()) {
  for (const KeyframeRegion& region : regions) regions_.push_back({.about = region});
  for (const KeyframePoint& point : points) {
    MotionPoint p;
    p.ray = {point.x, point.y, 1.0};
    p.inverse_depth = point.inverse_depth;
    p.region = point.region;
    points_.push_back(p);
  }
  place_middles(points);
  add_own_columns(points);
  // Where nothing rests, a turn and a shift cannot be told apart: f and t are all there is.
  const bool rests = std::any_of(regions.begin(), regions.end(), [](const KeyframeRegion& region) {
    return region.kind != KeyframeRegion::Kind::kMoving;
  });
  learns_tilt_ = !rests;
  if (rests) tilt_variance_ = 1.0;  // free: what rests tells roll from bending
  const double d = config.distance_mm, face = config.perspective ? kFace_rad : 0.0;
  const double turn = config.perspective && (rests || config.turns_measured) ? 1.0 : 0.0;
  base_ << turn, turn, 1.0, d, d, d, face, face;
  log_variance_ = {2.0 * std::log(kTurn_rad), 2.0 * std::log(kShift)};
  set_sd();
  process_.start(sd_);
}

double CameraMotion::mean_share(const std::vector<KeyframePoint>& points) noexcept {
  double sum = 0.0;
  for (const KeyframePoint& point : points) sum += point.readout_share;
  return points.empty() ? 0.0 : sum / static_cast<double>(points.size());
}

// c: of all points in the structure's plane alike; of each far region its own.
void CameraMotion::place_middles(const std::vector<KeyframePoint>& points) {
  std::vector<Eigen::Vector3d> own(regions_.size(), Eigen::Vector3d::Zero());
  std::vector<double> count(regions_.size(), 0.0);
  Eigen::Vector3d structure = Eigen::Vector3d::Zero();  // mm
  double n_structure = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    own[points[i].region] += points_[i].ray;
    count[points[i].region] += 1.0;
    if (!in_plane(points_[i])) continue;
    structure += points_[i].ray / points_[i].inverse_depth;
    n_structure += 1.0;
  }
  if (n_structure > 0.0) structure /= n_structure;
  if (structure.z() > 0.0) middle_ = structure / structure.z();
  for (MotionPoint& p : points_) {
    p.middle =
        in_plane(p) ? Eigen::Vector3d(p.inverse_depth * structure) : Eigen::Vector3d(own[p.region] / count[p.region]);
  }
}

// Background has a middle of its own, known depth or not.
bool CameraMotion::in_plane(const MotionPoint& point) const noexcept {
  return point.inverse_depth > 0.0 && !regions_[point.region].about.background;
}

void CameraMotion::add_own_columns(const std::vector<KeyframePoint>& points) {
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    MotionRegion& region = regions_[r];
    const auto of_region = [&](std::size_t i) { return points_[i].region == r; };
    Eigen::Vector3d ray = Eigen::Vector3d::Zero();
    double share = 0.0, count = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!of_region(i)) continue;
      ray += points_[i].ray, share += points[i].readout_share, count += 1.0;
    }
    if (count > 0.0) ray /= count, share /= count;
    region.share = share;
    const auto add = [&](double sd, const auto& column) {
      region.prior_sd(region.n_own) = sd;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        if (of_region(i)) points_[i].own.col(region.n_own) = column(i);
      }
      ++region.n_own;
    };
    const auto from_middle = [&](std::size_t i) { return Eigen::Vector3d(points_[i].ray - ray); };
    const double d = config_.distance_mm;
    if (region.about.kind == KeyframeRegion::Kind::kMoving) {
      for (int a = 0; a < region.about.n_axes; ++a) {
        const Eigen::Vector3d axis = region.about.axis[static_cast<std::size_t>(a)];
        add(kSlide * d, [&](std::size_t i) { return Eigen::Vector3d(points_[i].inverse_depth * axis); });
        region.by_row[static_cast<std::size_t>(region.n_own)] = true;
        add(kSlidePerReadout * d, [&](std::size_t i) { return Eigen::Vector3d(points_[i].inverse_depth * axis); });
      }
      region.i_tilt = region.n_own;
      add(1.0, [&](std::size_t i) { return region.about.normal.cross(from_middle(i)); });
    } else if (region.about.kind == KeyframeRegion::Kind::kFar) {
      add(kZoom, from_middle);
      if (config_.perspective) continue;  // else what it shifts by is no turn
      add(kFarShift, [](std::size_t) { return Eigen::Vector3d(Eigen::Vector3d::UnitX()); });
      add(kFarShift, [](std::size_t) { return Eigen::Vector3d(Eigen::Vector3d::UnitY()); });
    }
  }
}

void CameraMotion::set_sd() noexcept {
  log_variance_[0] = std::clamp(log_variance_[0], 2.0 * std::log(kLeastTurn_rad), 2.0 * std::log(kMostTurn_rad));
  log_variance_[1] = std::clamp(log_variance_[1], 2.0 * std::log(kLeastShift), 2.0 * std::log(kMostShift));
  sd_ = base_;
  sd_.segment<3>(kPitch) *= std::exp(0.5 * log_variance_[0]);
  sd_.segment<3>(kShiftX) *= std::exp(0.5 * log_variance_[1]);
  for (MotionRegion& region : regions_) {
    if (region.i_tilt >= 0) region.prior_sd(region.i_tilt) = std::sqrt(tilt_variance_);
  }
}

void CameraMotion::predict(double t_s) noexcept {
  raised_ = false;
  settled_ = process_;
  dt_s_ = std::max(0.0, t_s - t_s_);
  t_s_ += dt_s_;
  before_ = settled_;
  before_.predict(dt_s_, sd_);
  process_ = before_;
}

// The derivatives by time enter as what they are now estimated to be: rows tell them too, but a wrong readout time, and
// what moved while the keyframe itself was read, would pass for them.
void CameraMotion::iterate(const MotionObservation& seen) noexcept {
  process_ = before_;
  MotionStateVector linear = before_.mean(), step = MotionStateVector::Zero();
  for (int pass = 0; pass < kIterations; ++pass) {
    equations_.build(linear, points_, regions_, seen, pass > 0);
    const MotionVector ahead = (linear - before_.mean()).head<n>();
    MotionMatrix information = equations_.information();
    MotionVector gradient = equations_.gradient();
    add_turn(linear, information, gradient);
    if (!process_.step(information, gradient + information * ahead, step)) {
      ++n_failed_;
      process_ = before_;
      return;
    }
    equations_.update_own(step.head<n>() - ahead, regions_);
    linear = before_.mean() + step;
  }
  process_.accept(step);
}

void CameraMotion::add_turn(const MotionStateVector& linear, MotionMatrix& information,
                            MotionVector& gradient) const noexcept {
  if (!turn_ || !config_.perspective) return;
  const double weight = 1.0 / (turn_->sigma_rad * turn_->sigma_rad);
  information.diagonal().segment<3>(kPitch).array() += weight;
  gradient.segment<3>(kPitch) += weight * (turn_->turn_rad - linear.segment<3>(kPitch));
}

void CameraMotion::correct(const MotionObservation& seen) noexcept {
  iterate(seen);
  if (raised_ || !surprised()) return;
  raised_ = true;
  set_sd();
  before_ = settled_;
  before_.predict(dt_s_, sd_);
  iterate(seen);
}

// A group of components that moved by far more than its prior lets it: the prior is widened at once.
bool CameraMotion::surprised() noexcept {
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
void CameraMotion::learn() noexcept {
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
  double square = 0.0, count = 0.0;
  for (const MotionRegion& region : regions_) {
    if (region.i_tilt < 0 || region.n_used < kPointsForTilt) continue;
    square += region.value(region.i_tilt) * region.value(region.i_tilt) + region.tilt_sd * region.tilt_sd;
    count += 1.0;
  }
  if (learns_tilt_ && count > 0.0) {
    tilt_variance_ += kTiltRate * (square / count - tilt_variance_);
    tilt_variance_ = std::max(tilt_variance_, kLeastTilt_rad * kLeastTilt_rad);
  }
}

void CameraMotion::settle() noexcept {
  find_open();
  learn();
  set_sd();
}

// From the component that is known worst, in px at the channels: what is open is taken as given, the rest judged again.
void CameraMotion::find_open() noexcept {
  position_covariance_ = process_.covariance().topLeftCorner<n, n>();
  open_.fill(false);
  for (int round = 0; round < n; ++round) {
    int worst = -1;
    double worst_px = kOpen_px;
    for (int i = 0; i < n; ++i) {
      double effect = 0.0;
      for (const MotionRegion& region : regions_) {
        if (region.about.kind != KeyframeRegion::Kind::kMoving) continue;
        for (int a = 0; a < region.about.n_axes; ++a) {
          const Eigen::Vector3d& axis = region.about.axis[static_cast<std::size_t>(a)];
          effect = std::max(effect, std::abs(axis.x() * region.effect(0, i) + axis.y() * region.effect(1, i)));
        }
      }
      const double px = effect * std::sqrt(std::max(0.0, position_covariance_(i, i)));
      if (px > worst_px) worst = i, worst_px = px;
    }
    if (worst < 0) return;
    open_[static_cast<std::size_t>(worst)] = true;
    const MotionVector column = position_covariance_.col(worst);
    position_covariance_ -= column * column.transpose() / column(worst);
    position_covariance_.row(worst).setZero();
    position_covariance_.col(worst).setZero();
  }
}

double CameraMotion::sigma_px(std::size_t region, double e_u, double e_v) const noexcept {
  const MotionVector effect = (Eigen::RowVector2d(e_u, e_v) * regions_[region].effect).transpose();
  return std::sqrt(std::max(0.0, effect.dot(position_covariance_ * effect)));
}

// The point's ray of this frame in keyframe axes, up to the point's plane.
Vector2 CameraMotion::stabilised(std::size_t i, const Vector2& position, double share) const noexcept {
  const MotionPoint& point = points_[i];
  const MotionPose pose = equations_.pose(process_.mean(), share);
  const Eigen::Vector3d seen(position.u / config_.fx, position.v / config_.fy, 1.0);
  // seen ~ R(w) [c + R(f) (x)], x = where the point is now in the keyframe's axes, from c, up to a factor.
  const Eigen::Vector3d direction = pose.face.transpose() * (pose.turn.transpose() * seen);
  const Eigen::Vector3d origin = point.inverse_depth * pose.shift + pose.face.transpose() * point.middle;
  const Eigen::Vector3d rest = point.ray - point.middle;
  const Eigen::Vector3d& normal = regions_[point.region].about.normal;
  const Eigen::Vector3d moved = direction * (normal.dot(rest + origin) / normal.dot(direction)) - origin - rest;
  const double z = 1.0 + moved.z();
  return {config_.fx * ((point.ray.x() + moved.x()) / z - point.ray.x()),
          config_.fy * ((point.ray.y() + moved.y()) / z - point.ray.y())};
}

double CameraMotion::magnification() const noexcept {
  const MotionPose pose(process_.mean().head<n>());
  return 1.0 / (pose.turn * (middle_ + pose.face * pose.shift / config_.distance_mm)).z();
}

}  // namespace core
