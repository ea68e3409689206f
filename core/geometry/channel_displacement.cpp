#include "core/geometry/channel_displacement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/geometry/channel_layout.h"
#include "core/geometry/keyframe_view.h"
#include "core/geometry/resting_region.h"
#include "core/tracking/outlier_rejection.h"
#include "core/types/witness.h"

namespace core {

namespace {

// Lower bound of a point's sigma, set by rounding and optics; it bounds the weights.
constexpr double kLeastSigmaPx = 0.003;

// Least spread of a static region along the rows, in heights of the image, to witness the camera's rotation.
constexpr double kLeastSpread = 0.07;

// The keyframe as the declared camera, without corrections, would have seen it.
TrackFrame as_declared(const ChannelDisplacementConfig& config, const TrackFrame& keyframe) {
  TrackFrame out = keyframe;
  if (!config.places.corrects() || !config.places.in_keyframe) return out;
  for (TrackPoint& p : out.points) {
    const Vector2 raw = config.camera.distort(config.places.corrected(config.camera.undistort({p.u_px, p.v_px})));
    if (std::isfinite(raw.u) && std::isfinite(raw.v)) p.u_px = raw.u, p.v_px = raw.v;
  }
  return out;
}

}  // namespace

ChannelDisplacement::ChannelDisplacement(ChannelDisplacementConfig config, const TrackFrame& raw_keyframe)
    : config_(std::move(config)),
      corrects_places_(config_.places.corrects()),
      scale_(scale_points(config_.regions, config_.camera, as_declared(config_, raw_keyframe))) {
  const TrackFrame keyframe = as_declared(config_, raw_keyframe);
  if (!config_.camera.calibrated()) {  // only the principal point is needed then
    config_.camera.cx = 0.5 * (config_.readout.width_px - 1);
    config_.camera.cy = 0.5 * (config_.readout.height_px - 1);
  }
  const std::size_t n = keyframe.points.size();
  ranges_.resize(config_.regions.size());
  for (std::size_t i = 0; i < n; ++i) {
    RegionRange& range = ranges_[keyframe.points[i].region];
    if (range.end == range.begin) range.begin = i;
    range.end = i + 1;
    const double sigma_px = std::max(kLeastSigmaPx, keyframe.points[i].sigma_px);  // a NaN becomes the lower bound
    weight_.push_back(1.0 / (sigma_px * sigma_px));
    const Vector2 ideal = config_.camera.undistort({keyframe.points[i].u_px, keyframe.points[i].v_px});
    keyframe_.push_back({ideal.u - config_.camera.cx, ideal.v - config_.camera.cy});
    readout_share_.push_back(config_.readout.fraction(raw_keyframe.points[i].u_px, raw_keyframe.points[i].v_px));
  }
  position_ = motion_ = turned_ = keyframe_;
  config_.following = following_with(config_.following, config_.attitude.has_value());
  share_now_ = readout_share_;
  sigma_px_.assign(n, 0.0);
  seen_.assign(n, 0);
  inlier_ = inlier_before_ = seen_;
  if (config_.paper_method) shutter_ = make_published_shutter();
  make_channels();
  if (!config_.adaptive_scale || config_.following == CameraFollowing::kDistance || config_.paper_method) return;
  if (config_.following == CameraFollowing::kSlow) {
    if (!config_.camera.calibrated() || n_witnesses() == 0) return;
    slow_rotation_.emplace(config_.camera.fx, config_.camera.fy);
    t_turned_ns_ = keyframe.t_start_ns;
    return;
  }
  const bool turns_measured = config_.attitude && config_.camera.calibrated();
  if (!turns_measured && !tells_camera_motion(config_.regions, config_.camera)) return;
  camera_motion_.emplace(make_camera_motion(config_.regions, config_.camera, config_.readout, config_.scale_mm_per_px,
                                            keyframe, config_.plane));
  if (!turns_measured) return;
  const double mean_share = std::accumulate(readout_share_.begin(), readout_share_.end(), 0.0) /
                            static_cast<double>(std::max<std::size_t>(n, 1));
  config_.attitude->delay_s += config_.readout.readout_s * mean_share;  // to the instant of the state
  attitude_.emplace(*config_.attitude);
  attitude_->before(*camera_motion_, static_cast<double>(keyframe.t_start_ns) * 1e-9);
}

// Delays use the same weights as the channel's mean.
std::vector<RegionPoints> ChannelDisplacement::region_points() const {
  std::vector<RegionPoints> out;
  for (const RegionRange& range : ranges_) {
    double share = 0.0, weight = 0.0;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      share += weight_[i] * readout_share_[i];
      weight += weight_[i];
    }
    const bool is_late = weight > 0.0 && !config_.paper_method;
    out.push_back({range.size(), is_late ? config_.readout.readout_s * share / weight : 0.0,
                   spread_of_turn_px({keyframe_.data() + range.begin, range.size()},
                                     {readout_share_.data() + range.begin, range.size()})});
  }
  return out;
}

void ChannelDisplacement::make_channels() {
  const std::vector<RegionPoints> points = region_points();
  channels_ = channel_layout(config_.regions, points);
  spectra_ = channels_;
  if (!config_.witness || config_.following == CameraFollowing::kWhole || config_.paper_method) return;
  const WitnessNeeds needs{config_.min_points, kLeastSpread * config_.readout.height_px};
  for (ChannelInfo& witness : witness_layout(config_.regions, points, channels_, needs))
    spectra_.push_back(std::move(witness));
}

// The camera's velocity relative to the structure is measured where the structure does not vibrate: at its base. If no
// base is declared, all points are used; their mean then contains part of every mode's velocity.
PublishedShutter ChannelDisplacement::make_published_shutter() const {
  const std::vector<Region>& all = config_.regions;
  const bool has_base =
      std::any_of(all.begin(), all.end(), [](const Region& region) { return region.role == RegionRole::kBase; });
  std::vector<PublishedShutter::Region> regions;
  for (std::size_t r = 0; r < ranges_.size(); ++r) {
    const bool follows = has_base ? all[r].role == RegionRole::kBase : makes_channel(all[r].role);
    regions.push_back({ranges_[r].begin, ranges_[r].end, follows});
  }
  return {config_.shutter_velocity, std::move(regions), keyframe_.size()};
}

DisplacementSample ChannelDisplacement::sample_prototype() const {
  DisplacementSample sample;
  sample.value_mm.assign(channels_.size(), 0.0);
  sample.sigma_mm.assign(channels_.size(), 0.0);
  sample.seen.assign(channels_.size(), 0);
  sample.n_points.assign(channels_.size(), 0);
  sample.witness_mm.assign(n_witnesses(), 0.0);
  sample.witness_seen.assign(n_witnesses(), 0);
  return sample;
}

void ChannelDisplacement::place_points(const TrackFrame& tracks) noexcept {
  for (std::size_t i = 0; i < keyframe_.size(); ++i) {
    seen_[i] = 0;
    if (slow_rotation_) turned_[i] = slow_rotation_->turned(keyframe_[i], after_resting_s(i));
    if (i >= tracks.points.size()) continue;
    const TrackPoint& point = tracks.points[i];
    if (!point.seen || !std::isfinite(point.u_px) || !std::isfinite(point.v_px)) continue;
    Vector2 ideal = config_.camera.undistort({point.u_px, point.v_px});
    if (corrects_places_) ideal = config_.places.corrected(ideal);
    const Vector2 by{turned_[i].u - keyframe_[i].u, turned_[i].v - keyframe_[i].v};
    position_[i] = {ideal.u - config_.camera.cx - by.u, ideal.v - config_.camera.cy - by.v};
    share_now_[i] = config_.readout.fraction(point.u_px, point.v_px);
    const bool stated = std::isfinite(point.sigma_px) && point.sigma_px >= 0.0;
    sigma_px_[i] = stated ? point.sigma_px : 1.0 / std::sqrt(weight_[i]);
    // Far outside the image a lens model may have no inverse.
    seen_[i] = std::isfinite(position_[i].u) && std::isfinite(position_[i].v) ? 1 : 0;
  }
}

// Motion since the keyframe in keyframe pixels: p / b - p0.
void ChannelDisplacement::remove_scale(double magnification) noexcept {
  for (std::size_t i = 0; i < keyframe_.size(); ++i) {
    motion_[i] = {position_[i].u / magnification - keyframe_[i].u, position_[i].v / magnification - keyframe_[i].v};
  }
}

void ChannelDisplacement::stabilise() noexcept {
  for (std::size_t i = 0; i < keyframe_.size(); ++i) {
    if (seen_[i] != 0) motion_[i] = camera_motion_->stabilised(i, position_[i], share_now_[i]);
  }
}

void ChannelDisplacement::reject_outliers() noexcept {
  MlesacConfig mlesac;
  mlesac.sigma_px = config_.inlier_sigma_px;
  for (const RegionRange& range : ranges_) {
    const std::size_t n = range.end - range.begin;
    (void)mlesac_translation({motion_.data() + range.begin, n}, {seen_.data() + range.begin, n}, mlesac,
                             {inlier_.data() + range.begin, n});
  }
}

double ChannelDisplacement::estimate_scale() noexcept {
  remove_scale(config_.adaptive_scale ? scale_.median_of_pairs(position_, seen_) : 1.0);
  reject_outliers();
  if (!config_.adaptive_scale) return 1.0;
  const double b =
      config_.paper_method ? scale_.two_point(position_, inlier_) : scale_.least_squares(position_, inlier_);
  remove_scale(b);
  reject_outliers();
  return b;
}

// Outliers are rejected relative to the predicted motion. After an unpredicted jump most points would be outliers: then
// all seen points are used (with Huber weights), and are rejected relative to the result.
double ChannelDisplacement::follow_camera(std::int64_t t_start_ns) noexcept {
  camera_motion_->predict(static_cast<double>(t_start_ns) * 1e-9);
  if (attitude_) attitude_->before(*camera_motion_, static_cast<double>(t_start_ns) * 1e-9);
  stabilise();
  reject_outliers();
  const auto count = [](const std::vector<std::uint8_t>& flags) {
    return std::count(flags.begin(), flags.end(), std::uint8_t{1});
  };
  if (2 * count(inlier_) < count(seen_)) inlier_ = seen_;
  camera_motion_->correct({position_, share_now_, sigma_px_, inlier_});
  stabilise();
  inlier_before_ = inlier_;
  reject_outliers();
  if (inlier_ != inlier_before_) {
    camera_motion_->correct({position_, share_now_, sigma_px_, inlier_});
    stabilise();
  }
  if (camera_motion_->settle()) stabilise();
  if (attitude_) attitude_->after(*camera_motion_);
  contradiction_.add(4 * count(inlier_) < count(seen_), largest_resting_px());
  return camera_motion_->magnification();
}

double ChannelDisplacement::largest_resting_px() const noexcept {
  double largest = 0.0;
  for (std::size_t r = 0; r < ranges_.size(); ++r) {
    if (makes_channel(config_.regions[r].role)) continue;
    const Average left = average(static_cast<std::uint16_t>(r));
    if (left.enough) largest = std::max(largest, std::hypot(left.mean_px.u, left.mean_px.v));
  }
  return largest;
}

double ChannelDisplacement::scale_of(std::uint16_t region) const noexcept {
  return region < config_.region_scale_mm_per_px.size() ? config_.region_scale_mm_per_px[region]
                                                        : config_.scale_mm_per_px;
}

ChannelDisplacement::Average ChannelDisplacement::average(std::uint16_t region) const noexcept {
  const RegionRange& range = ranges_[region];
  double weight = 0.0, variance = 0.0;
  Vector2 sum;
  Average out;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (inlier_[i] == 0) continue;
    sum.u += weight_[i] * motion_[i].u;
    sum.v += weight_[i] * motion_[i].v;
    weight += weight_[i];
    variance += weight_[i] * weight_[i] * sigma_px_[i] * sigma_px_[i];
    ++out.n_points;
  }
  if (!(weight > 0.0)) return out;
  out.enough = out.n_points >= config_.min_points;
  out.mean_px = {sum.u / weight, sum.v / weight};
  out.sigma_px = std::sqrt(variance) / weight;
  return out;
}

void ChannelDisplacement::average_channel(std::size_t channel, double magnification,
                                          DisplacementSample& out) const noexcept {
  const ChannelInfo& info = channels_[channel];
  const Average mean = average(info.region);
  const double s0 = scale_of(info.region);
  const double camera_px =
      follows_camera() ? camera_motion_->sigma_px(info.region, info.direction_u, info.direction_v) : 0.0;
  out.seen[channel] = mean.enough ? 1 : 0;
  out.n_points[channel] = mean.n_points;
  out.value_mm[channel] = mean.enough ? s0 * mean.along(info) : 0.0;
  out.sigma_mm[channel] = mean.enough ? s0 * std::hypot(mean.sigma_px, camera_px) / magnification : 0.0;
}

// A static region at another distance has another zoom; its points share one motion only after removal of that zoom.
void ChannelDisplacement::follow_what_rests(DisplacementSample& out) noexcept {
  if (n_witnesses() == 0) return;
  const std::uint16_t region = spectra_.back().region;
  const RestingPoints points{resting(position_), resting(keyframe_), resting(turned_), resting(seen_),
                             resting(readout_share_)};
  const double turn_rad = follow_resting_region(points, config_.inlier_sigma_px, resting(motion_), resting(inlier_));
  const Average mean = average(region);
  for (std::size_t w = 0; w < out.witness_mm.size(); ++w) {
    const ChannelInfo& witness = spectra_[channels_.size() + w];
    const double moved_px = witnesses_turn(witness) ? 0.5 * config_.readout.height_px * turn_rad : mean.along(witness);
    out.witness_mm[w] = mean.enough ? config_.scale_mm_per_px * moved_px : 0.0;
    out.witness_seen[w] = mean.enough ? 1 : 0;
  }
  if (!slow_rotation_) return;
  const double dt_s = 1e-9 * static_cast<double>(out.t_start_ns - t_turned_ns_);
  if (!mean.enough || !(dt_s > 0.0)) return;
  const bool shows_turn = witnesses_turn(spectra_.back());
  const Eigen::Matrix3d shown = shown_rotation(points, resting(inlier_), config_.camera.fx, config_.camera.fy);
  slow_rotation_->add({mean.mean_px, shows_turn ? turn_rad : 0.0}, shown, dt_s);
  t_turned_ns_ = out.t_start_ns;
}

void ChannelDisplacement::update(TrackFrame& tracks, DisplacementSample& out) noexcept {
  out.sequence = tracks.sequence;
  out.t_start_ns = tracks.t_start_ns;
  out.gap_before = tracks.gap_before;
  place_points(tracks);
  const double magnification = follows_camera() ? follow_camera(tracks.t_start_ns) : estimate_scale();
  follow_what_rests(out);
  for (std::size_t i = 0; i < keyframe_.size() && i < tracks.points.size(); ++i)
    tracks.points[i].inlier = inlier_[i] != 0;
  if (config_.paper_method) shutter_.correct(tracks.sequence, readout_share_, inlier_, motion_);
  out.scale_mm_per_px = config_.scale_mm_per_px / magnification;
  for (std::size_t c = 0; c < channels_.size(); ++c) average_channel(c, magnification, out);
}

}  // namespace core
