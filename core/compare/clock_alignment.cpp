#include "core/compare/clock_alignment.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/compare/offset_search.h"
#include "core/linear/eigen_kernels.h"

namespace core {
namespace {

constexpr double kLikelyClockError = 1e-4;  // which the first stretch must not feel
constexpr double kRivalEvidence = 8.0;
constexpr double kChanceMargin = 5.0;  // ln 150
constexpr std::size_t kMostCandidates = 12;
constexpr double kCandidateShare = 0.3;  // of the best evidence: between samples a peak may lose much
constexpr int kScoreBlocks = 24, kMostFitSteps = 30;

double edge_s(const BandLimited& record, const Band& band) {
  return std::min(1.0 / band.low_hz, 0.1 * record.duration_s());
}

// Least squares of camera(t) = ratio * (y(s) + share d(s)), y the sensor, s = t + offset + rate (t - middle), over the
// camera's samples in a stretch. d(s) = y(s) - y(s - frame) where a codec predicts from earlier frames,
// y(s + frame) - y(s - frame) where from both; without a codec the share is 0.
class ClockFit {
 public:
  ClockFit(const BandLimited& camera, double camera_rate_hz, const BandLimited& sensor, const Band& band,
           const VideoFrames& frames = {})
      : camera_(camera), sensor_(sensor), band_(band), frames_(frames), rate_hz_(camera_rate_hz) {}

  // False: too few samples, or no convergence.
  bool fit(double from_s, double to_s, ClockAlignment& out) {
    from_s_ = from_s, to_s_ = to_s;
    choose_samples(out);
    for (int step = 0; step < kMostFitSteps; ++step) {
      if (!add_equations(out)) return false;
      const Eigen::Vector4d change = solve(normal_, right_);
      if (!change.allFinite()) return false;
      out.ratio += change[kRatio], out.frame_share += change[kShare];
      const double most_s = 0.1 / band_.high_hz;
      out.clock.offset_s += std::clamp(change[kOffset], -most_s, most_s);
      out.clock.rate += std::clamp(change[kRate], -most_s / (to_s - from_s), most_s / (to_s - from_s));
      const double moved = std::abs(change[kOffset]) + std::abs(change[kRate]) * (to_s - from_s);
      if (moved < 1e-6 / band_.high_hz) return state_sigmas(out);
    }
    return false;
  }

  // Of the last fit: that of the camera's power which it explains.
  [[nodiscard]] double evidence() const {
    const double left = power_ > 0.0 ? std::clamp(error_ / power_, 1e-30, 1.0) : 1.0;
    return -band_.width_hz() * (static_cast<double>(sample_s_.size()) / rate_hz_) * std::log(left);
  }

 private:
  enum Unknown : std::uint8_t { kRatio, kOffset, kRate, kShare };

  static Eigen::Vector4d solve(const Eigen::Matrix4d& matrix, const Eigen::Vector4d& right) {
    const Eigen::Vector4d scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::Matrix4d scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
    return scale.asDiagonal() * (scaled.inverse() * (scale.asDiagonal() * right));
  }

  // The samples that count with the relation at the start: the same ones in all steps, so that these converge.
  void choose_samples(const ClockAlignment& start) {
    sample_s_.clear();
    const auto first = static_cast<std::int64_t>(std::ceil(from_s_ * rate_hz_));
    const auto last = static_cast<std::int64_t>(std::floor(to_s_ * rate_hz_));
    for (std::int64_t k = first; k <= last; ++k) {
      const double t_s = static_cast<double>(k) / rate_hz_;
      if (counts(camera_, sensor_, band_, start.clock, t_s)) sample_s_.push_back(t_s);
    }
  }

  // Derivatives of the model by the unknowns at one instant; `model`: its value.
  [[nodiscard]] Eigen::Vector4d row_at(const ClockAlignment& at, double t_s, double& model) const {
    const double sensor_s = at.clock.sensor_s(t_s);
    double value = sensor_.at(sensor_s), slope = sensor_.slope_at(sensor_s), moved = 0.0;
    if (frames_.share_motion()) {
      const double before_s = sensor_s - frames_.interval_s;
      const double after_s = frames_.prediction == FramePrediction::kBoth ? sensor_s + frames_.interval_s : sensor_s;
      moved = sensor_.at(after_s) - sensor_.at(before_s);
      slope += at.frame_share * (sensor_.slope_at(after_s) - sensor_.slope_at(before_s));
      value += at.frame_share * moved;
    }
    model = at.ratio * value;
    return {value, at.ratio * slope, at.ratio * slope * (t_s - at.clock.middle_s), at.ratio * moved};
  }

  bool add_equations(const ClockAlignment& at) {
    normal_.setZero(), right_.setZero();
    scores_.assign(kScoreBlocks, Eigen::Vector4d::Zero());
    normals_.assign(kScoreBlocks, Eigen::Matrix4d::Zero());
    error_ = power_ = 0.0;
    for (const double t_s : sample_s_) {
      double model = 0.0;
      const Eigen::Vector4d row = row_at(at, t_s, model);
      const double seen = camera_.at(t_s), residual = seen - model;
      error_ += residual * residual, power_ += seen * seen;
      normal_ += row * row.transpose();
      right_ += row * residual;
      const double place = kScoreBlocks * (t_s - from_s_) / (to_s_ - from_s_);
      const auto block = static_cast<std::size_t>(std::clamp(place, 0.0, kScoreBlocks - 1.0));
      scores_[block] += row * residual;
      normals_[block] += row * row.transpose();
    }
    add_prior(at);
    return sample_s_.size() >= static_cast<std::size_t>(kScoreBlocks);
  }

  // What is known of the share beforehand, in units of the residual's variance per independent sample. Without a codec
  // the share stays what it is.
  void add_prior(const ClockAlignment& at) {
    prior_ = 1.0;
    if (frames_.share_motion()) {
      const double dependence = std::max(1.0, rate_hz_ / (2.0 * band_.width_hz()));
      const auto n = static_cast<double>(std::max<std::size_t>(1, sample_s_.size()));
      prior_ = std::max(dependence * error_ / n, 1e-12 * power_ / n) / (frames_.share_std() * frames_.share_std());
      right_[kShare] -= prior_ * at.frame_share;
    }
    normal_(kShare, kShare) += prior_;
  }

  // Jackknife over blocks of the record, to first order: without block b the result changes by -(N - N_b)^-1 times the
  // score of b. Right for a residual of any colour within a block, and where few blocks hold most of the motion. To
  // this comes what the prior's own uncertainty leaves.
  bool state_sigmas(ClockAlignment& out) {
    if (!add_equations(out)) return false;
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
    for (std::size_t b = 0; b < scores_.size(); ++b) {
      const Eigen::Vector4d change = solve(normal_ - normals_[b], scores_[b]);
      covariance += change * change.transpose();
    }
    covariance *= (kScoreBlocks - 1.0) / kScoreBlocks;
    if (frames_.share_motion()) {
      const Eigen::Vector4d pulled = solve(normal_, prior_ * frames_.share_std() * Eigen::Vector4d::Unit(kShare));
      covariance += pulled * pulled.transpose();
    }
    const auto sigma = [&](Unknown of) { return std::sqrt(std::max(0.0, covariance(of, of))); };
    out.ratio_std = sigma(kRatio), out.frame_share_std = sigma(kShare);
    out.clock.offset_std_s = sigma(kOffset), out.clock.rate_std = sigma(kRate);
    return covariance.allFinite();
  }

  const BandLimited& camera_;
  const BandLimited& sensor_;
  Band band_;
  VideoFrames frames_;
  double rate_hz_;
  double from_s_ = 0.0, to_s_ = 0.0;
  Eigen::Matrix4d normal_;
  Eigen::Vector4d right_;
  std::vector<Eigen::Vector4d> scores_;   // per block of the stretch
  std::vector<Eigen::Matrix4d> normals_;  // per block
  std::vector<double> sample_s_;
  double error_ = 0.0, power_ = 0.0, prior_ = 1.0;
};

// What both records share, with the offset set.
void set_shared(const BandLimited& camera, const BandLimited& sensor, double offset_s, ClockAlignment& out) {
  out.clock = {};
  out.clock.offset_s = offset_s;
  out.from_s = std::max(0.0, -offset_s);
  out.to_s = std::min(camera.duration_s(), sensor.duration_s() - offset_s);
  out.clock.middle_s = 0.5 * (out.from_s + out.to_s);
}

double first_half_s(const BandLimited& camera, const Band& band) {
  return 0.5 * std::min(camera.duration_s(), 0.1 / (band.high_hz * kLikelyClockError));
}

// A fit over the first stretch, in the middle of what both share, then over longer ones.
bool fit_first(ClockFit& fit, double half_s, ClockAlignment& out) {
  half_s = std::min(half_s, 0.5 * (out.to_s - out.from_s));
  return fit.fit(out.clock.middle_s - half_s, out.clock.middle_s + half_s, out);
}
bool fit_all(ClockFit& fit, double half_s, ClockAlignment& out) {
  const double shared_half_s = 0.5 * (out.to_s - out.from_s);
  while (half_s < shared_half_s) {
    half_s = std::min(2.0 * half_s, shared_half_s);
    if (!fit.fit(out.clock.middle_s - half_s, out.clock.middle_s + half_s, out)) return false;
  }
  return true;
}

struct FittedOffset {
  ClockAlignment alignment;
  double evidence = 0.0;
  bool is_fitted = true;  // false: no convergence; a better candidate is then not passed over in silence
};

// The candidates after a fit of each, the best one first; those that arrive at the same offset once.
std::vector<FittedOffset> fitted_candidates(const BandLimited& camera, const BandLimited& sensor, const Band& band,
                                            ClockFit& fit, const std::vector<CoarseOffset>& peaks, double half_s) {
  std::vector<FittedOffset> out;
  for (std::size_t k = 0; k < std::min(peaks.size(), kMostCandidates); ++k) {
    if (peaks[k].evidence < kCandidateShare * peaks.front().evidence) break;
    FittedOffset one;
    set_shared(camera, sensor, peaks[k].offset_s, one.alignment);
    one.alignment.ratio = peaks[k].negative ? -1.0 : 1.0;
    one.is_fitted = fit_first(fit, half_s, one.alignment);
    one.evidence = one.is_fitted ? fit.evidence() : peaks[k].evidence;
    if (!one.is_fitted) one.alignment.clock.offset_s = peaks[k].offset_s;
    const double offset_s = one.alignment.clock.offset_s;
    const bool is_known = std::any_of(out.begin(), out.end(), [&](const FittedOffset& other) {
      return std::abs(other.alignment.clock.offset_s - offset_s) < 0.1 / band.high_hz;
    });
    if (!is_known) out.push_back(one);
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.evidence > b.evidence; });
  return out;
}

}  // namespace

bool counts(const BandLimited& camera, const BandLimited& sensor, const Band& band, const ClockRelation& clock,
            double camera_s) noexcept {
  const double sensor_s = clock.sensor_s(camera_s);
  const double camera_edge = edge_s(camera, band), sensor_edge = edge_s(sensor, band);
  return camera_s >= camera_edge && camera_s <= camera.duration_s() - camera_edge && sensor_s >= sensor_edge &&
         sensor_s <= sensor.duration_s() - sensor_edge && camera.is_seen(camera_s) && sensor.is_seen(sensor_s);
}

ClockAlignment align_clocks(const BandLimited& camera, double camera_rate_hz, const BandLimited& sensor,
                            const Band& band, const ClockSearch& search) {
  ClockAlignment none;
  const double middle_s = 0.5 * camera.duration_s(), half_s = first_half_s(camera, band);
  OffsetSearch offsets(camera, sensor, band, middle_s - half_s, middle_s + half_s);
  const std::vector<CoarseOffset> peaks = offsets.peaks(search.most_offset_s);
  if (peaks.empty()) return none;
  none.evidence = peaks.front().evidence;
  none.chance = std::log(offsets.n_trials()) + kChanceMargin;
  if (none.evidence < none.chance) return none;
  ClockFit fit(camera, camera_rate_hz, sensor, band);
  const std::vector<FittedOffset> candidates = fitted_candidates(camera, sensor, band, fit, peaks, half_s);
  if (candidates.empty() || !candidates.front().is_fitted) return none;
  ClockAlignment out = candidates.front().alignment;
  out.evidence = candidates.front().evidence, out.chance = none.chance;
  if (candidates.size() > 1 && candidates[1].evidence > out.evidence - kRivalEvidence)
    out.rival = {candidates[1].alignment.clock.offset_s, out.evidence - candidates[1].evidence};
  out.found = fit_all(fit, half_s, out);
  return out;
}

ClockAlignment refine_clocks(const BandLimited& camera, double camera_rate_hz, const BandLimited& sensor,
                             const Band& band, const ClockAlignment& start, const VideoFrames& frames) {
  ClockAlignment out = start;
  ClockFit fit(camera, camera_rate_hz, sensor, band, frames);
  out.found = fit.fit(out.from_s, out.to_s, out);
  return out;
}

}  // namespace core
