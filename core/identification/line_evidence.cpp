#include "core/identification/line_evidence.h"

#include <algorithm>
#include <cmath>

#include "core/identification/camera_shape.h"
#include "core/identification/stabilisation.h"
#include "core/types/constants.h"

namespace core {

namespace {

using Complex = std::complex<double>;

// Above this similarity of the delays' phasors, removing the delays of two frequencies gives nearly the same shape.
constexpr double kMostAlike = 0.8;

// Shares of a segment: length of the two windows of lags, and start of the second.
constexpr double kWindow = 0.2, kLateStart = 0.4;
// Poles with more damping than kMostLineDamping are not lines. Between these limits only modes that decay many times
// over within the record are examined; the damping estimates of the others scatter too much.
constexpr double kMostLineDamping = 0.005, kSurelySmallDamping = 0.001;
constexpr double kLeastForgotten = 60.0;  // 2 pi zeta f T
// Within shorter lags the least damped structure loses less than a fifth and cannot be distinguished from a steady
// line. The record must also span many decay times: otherwise a free decay looks steady, too.
constexpr double kLeastModeDamping = 0.001, kLeastLoss = 0.2, kLeastRenewals = 10.0;
constexpr int kDifferences = 1;  // suppresses the hover drift

}  // namespace

void SpectralLineTest::find_camera(const std::vector<Complex>& observed, double apparent_hz,
                                   SpectralLineEvidence& out) const {
  const double rate_hz = folding_.rate_hz, limit_hz = std::max(folding_.max_frequency_hz, 0.5 * rate_hz);
  if (observed.size() < 5 || folding_.delay_s.size() != observed.size()) return;  // two unknowns plus redundancy
  const int reach = static_cast<int>(std::ceil(kFastestCamera_hz / rate_hz)) + 1;
  const auto near_a_mode = [&](double f) {
    for (int n = -reach; n <= reach; ++n) {
      const double other = apparent_hz + n * rate_hz;
      if (std::abs(other) <= limit_hz && phase_likeness(f - other, folding_.delay_s) > kMostAlike) return true;
    }
    return false;
  };
  for (int n = -reach; n <= reach; ++n) {
    const double f = apparent_hz + n * rate_hz;
    if (std::abs(f) <= limit_hz || std::abs(f) > kFastestCamera_hz || near_a_mode(f)) continue;
    const double share = camera_share(observed, f, folding_.delay_s);
    if (share > out.camera_mac) out.camera_mac = share, out.camera_hz = std::abs(f);
  }
}

// |sum over lags of phi' R(lag) phi exp(-i w lag)|, Hann weighted: magnitude of the shape's correlation at that
// frequency and lag.
double SpectralLineTest::envelope(const std::vector<Complex>& observed, double apparent_hz, int first_lag,
                                  int n_lags) const {
  const auto n = static_cast<int>(observed.size());  // witnesses follow after these
  const double turn = kTwoPi * apparent_hz / sums_.rate_hz;
  Complex sum = 0.0;
  for (int k = 0; k < n_lags; ++k) {
    const int lag = first_lag + k;
    Complex value = 0.0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        value += std::conj(observed[static_cast<std::size_t>(i)]) * correlations_.divided(i, j, lag) *
                 observed[static_cast<std::size_t>(j)];
      }
    }
    const double window = 0.5 - 0.5 * std::cos(kTwoPi * (k + 0.5) / n_lags);
    sum += window * value * std::polar(1.0, -turn * lag);
  }
  return std::abs(sum);
}

void SpectralLineTest::find_decay(const std::vector<Complex>& observed, const UnfoldedPole& pole,
                                  SpectralLineEvidence& out) {
  const double segment = 0.5 * sums_.n_fft;
  const int n_lags = static_cast<int>(kWindow * segment), late = static_cast<int>(kLateStart * segment);
  if (!status_) status_ = compute_correlations(sums_, late + n_lags, kDifferences, correlations_);
  if (*status_ != CorrelationStatus::kOk || correlations_.max_lag() < late + n_lags - 1 || n_lags < 2) return;
  const double apart_s = late / sums_.rate_hz;
  // Loss of a mode with the least damping of structures within these lags.
  if (kTwoPi * frequency_hz(pole.s) * apart_s * kLeastModeDamping < kLeastLoss) return;
  const double first = envelope(observed, pole.apparent_hz, 0, n_lags);
  const double last = envelope(observed, pole.apparent_hz, late, n_lags);
  if (!(first > 0.0 && last > 0.0)) return;
  out.late_share = last / first;
  out.late_damping_ratio = -std::log(out.late_share) / (kTwoPi * frequency_hz(pole.s) * apart_s);
}

SpectralLineEvidence SpectralLineTest::examine(const UnfoldedPole& pole) {
  SpectralLineEvidence evidence;
  const std::vector<Complex> observed = observed_shape(pole, folding_);
  find_camera(observed, pole.apparent_hz, evidence);
  const double damping = damping_ratio(pole.s), duration_s = sums_.n_remembered() / sums_.rate_hz;
  const double forgotten = kTwoPi * damping * frequency_hz(pole.s) * duration_s;
  const double renewals = kTwoPi * kLeastModeDamping * frequency_hz(pole.s) * duration_s;
  const bool can_tell = renewals > kLeastRenewals && (damping < kSurelySmallDamping || forgotten > kLeastForgotten);
  if (can_tell && damping < kMostLineDamping) find_decay(observed, pole, evidence);
  return evidence;
}

}  // namespace core
