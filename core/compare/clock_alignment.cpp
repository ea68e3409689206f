#include "core/compare/clock_alignment.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
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

// Least squares of camera(t) = ratio * sensor(t + offset + rate (t - middle)) over the camera's samples in a stretch.
class ClockFit {
 public:
  ClockFit(const BandLimited& camera, double camera_rate_hz, const BandLimited& sensor, const Band& band)
      : camera_(camera), sensor_(sensor), band_(band), rate_hz_(camera_rate_hz) {}

  // False: too few samples, or no convergence.
  bool fit(double from_s, double to_s, ClockAlignment& out) {
    from_s_ = from_s, to_s_ = to_s;
    choose_samples(out);
    for (int step = 0; step < kMostFitSteps; ++step) {
      if (!add_equations(out)) return false;
      const Eigen::Vector3d change = solve(normal_, right_);
      if (!change.allFinite()) return false;
      out.ratio += change[0];
      const double most_s = 0.1 / band_.high_hz;
      out.clock.offset_s += std::clamp(change[1], -most_s, most_s);
      out.clock.rate += std::clamp(change[2], -most_s / (to_s - from_s), most_s / (to_s - from_s));
      const double moved = std::abs(change[1]) + std::abs(change[2]) * (to_s - from_s);
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
  static Eigen::Vector3d solve(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& right) {
    const Eigen::Vector3d scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::Matrix3d scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
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

  bool add_equations(const ClockAlignment& at) {
    normal_.setZero(), right_.setZero();
    scores_.assign(kScoreBlocks, Eigen::Vector3d::Zero());
    normals_.assign(kScoreBlocks, Eigen::Matrix3d::Zero());
    error_ = power_ = 0.0;
    for (const double t_s : sample_s_) {
      const double sensor_s = at.clock.sensor_s(t_s), value = sensor_.at(sensor_s);
      const double slope = at.ratio * sensor_.slope_at(sensor_s);
      const Eigen::Vector3d row(value, slope, slope * (t_s - at.clock.middle_s));
      const double seen = camera_.at(t_s), residual = seen - at.ratio * value;
      error_ += residual * residual, power_ += seen * seen;
      normal_ += row * row.transpose();
      right_ += row * residual;
      const double place = kScoreBlocks * (t_s - from_s_) / (to_s_ - from_s_);
      const auto block = static_cast<std::size_t>(std::clamp(place, 0.0, kScoreBlocks - 1.0));
      scores_[block] += row * residual;
      normals_[block] += row * row.transpose();
    }
    return sample_s_.size() >= static_cast<std::size_t>(kScoreBlocks);
  }

  // Jackknife over blocks of the record, to first order: without block b the result changes by -(N - N_b)^-1 times the
  // score of b. Right for a residual of any colour within a block, and where few blocks hold most of the motion.
  bool state_sigmas(ClockAlignment& out) {
    if (!add_equations(out)) return false;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t b = 0; b < scores_.size(); ++b) {
      const Eigen::Vector3d change = solve(normal_ - normals_[b], scores_[b]);
      covariance += change * change.transpose();
    }
    covariance *= (kScoreBlocks - 1.0) / kScoreBlocks;
    out.ratio_std = std::sqrt(std::max(0.0, covariance(0, 0)));
    out.clock.offset_std_s = std::sqrt(std::max(0.0, covariance(1, 1)));
    out.clock.rate_std = std::sqrt(std::max(0.0, covariance(2, 2)));
    return covariance.allFinite();
  }

  const BandLimited& camera_;
  const BandLimited& sensor_;
  Band band_;
  double rate_hz_;
  double from_s_ = 0.0, to_s_ = 0.0;
  Eigen::Matrix3d normal_;
  Eigen::Vector3d right_;
  std::vector<Eigen::Vector3d> scores_;   // per block of the stretch
  std::vector<Eigen::Matrix3d> normals_;  // per block
  std::vector<double> sample_s_;
  double error_ = 0.0, power_ = 0.0;
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
                             const Band& band, const ClockAlignment& start) {
  ClockAlignment out = start;
  ClockFit fit(camera, camera_rate_hz, sensor, band);
  out.found = fit.fit(out.from_s, out.to_s, out);
  return out;
}

}  // namespace core
