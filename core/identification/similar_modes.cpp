#include "core/identification/similar_modes.h"

#include <algorithm>
#include <cmath>

#include "core/identification/mac.h"
#include "core/identification/verdict_words.h"

namespace core {

namespace {

constexpr double kTwinMac = 0.9;
constexpr double kTwinFrequency = 0.06;  // relative
// Two resonances closer than their widths are one to a short record unless their shapes differ: what a third one,
// folded onto them, leaves beside the mode has a mixed shape. The part of it that is not the mode's is then seen with
// row delays of another frequency, and is out of phase; that of a real close mode is in phase.
constexpr double kLeastMixedMpc = 0.9, kLeastRestMpc = 0.7;
// A steady force beside a mode moves the structure in that mode's shape, with next to no damping.
constexpr double kMostHarmonicDamping = 0.001, kMostLineShare = 0.3;  // of the mode's

bool is_line_beside(const Mode& line, const Mode& mode) noexcept {
  return line.damping_ratio < kMostHarmonicDamping && line.damping_ratio < kMostLineShare * mode.damping_ratio;
}

// Apart by less than the half-power widths of both together.
bool is_unresolved(const Mode& a, const Mode& b) noexcept {
  return std::abs(a.frequency_hz - b.frequency_hz) <
         std::abs(a.damping_ratio) * a.frequency_hz + std::abs(b.damping_ratio) * b.frequency_hz;
}

// MPC of what remains of a shape without its projection on another one.
double rest_mpc(const Mode& mixture, const Mode& mode) {
  std::complex<double> inner = 0.0;
  double norm = 0.0;
  for (std::size_t c = 0; c < mode.shape.size(); ++c) {
    inner += std::conj(mode.shape[c]) * mixture.shape[c];
    norm += std::norm(mode.shape[c]);
  }
  std::vector<std::complex<double>> rest = mixture.shape;
  for (std::size_t c = 0; c < rest.size(); ++c) rest[c] -= inner / norm * mode.shape[c];
  return mpc(rest);
}

// Nothing but noise remains of twins: there the whole shape decides.
bool is_mixture_beside(const Mode& mixture, const Mode& mode) {
  if (!(mixture.mpc < mode.mpc) || !is_unresolved(mixture, mode)) return false;
  const double alike = mac(mixture.shape, mode.shape);
  return alike > kTwinMac ? mixture.mpc < kLeastMixedMpc : rest_mpc(mixture, mode) < kLeastRestMpc;
}

}  // namespace

void reject_mixtures(std::vector<Mode>& modes) {
  for (Mode& mixture : modes) {
    for (const Mode& mode : modes) {
      if (mixture.verdict != Verdict::kStructural || mode.verdict != Verdict::kStructural) continue;
      if (!is_mixture_beside(mixture, mode)) continue;
      set(mixture, Verdict::kNumerical,
          in_words("not resolved from %.4f Hz: closer than their widths (MAC %.2f), and what its shape "
                   "has beside that mode's is not in phase (MPC %.2f)",
                   mode.frequency_hz, mac(mixture.shape, mode.shape), rest_mpc(mixture, mode)));
    }
  }
}

void reject_twins(std::vector<Mode>& modes) {
  for (Mode& a : modes) {
    for (Mode& b : modes) {
      if (&a == &b || a.verdict != Verdict::kStructural || b.verdict != Verdict::kStructural) continue;
      const bool near =
          std::abs(a.frequency_hz - b.frequency_hz) < kTwinFrequency * std::max(a.frequency_hz, b.frequency_hz);
      if (!near || mac(a.shape, b.shape) <= kTwinMac) continue;
      if (is_line_beside(a, b)) {
        set(a, Verdict::kHarmonic,
            in_words("a steady force: the shape of %.4f Hz beside it, with %.3f %% of damping", b.frequency_hz,
                     100.0 * a.damping_ratio));
        continue;
      }
      if (is_line_beside(b, a)) continue;  // handled in a later iteration
      Mode& weaker = a.presence < b.presence || (a.presence == b.presence && a.mpc < b.mpc) ? a : b;
      const Mode& stronger = &weaker == &a ? b : a;
      set(weaker, Verdict::kNumerical,
          in_words("twin of %.4f Hz with the same shape (amplitude dependent?)", stronger.frequency_hz));
    }
  }
}

}  // namespace core
