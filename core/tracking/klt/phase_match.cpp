#include "core/tracking/klt/phase_match.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {

constexpr double kParameters = 4.0;  // shift, gain and offset
constexpr double kLongestStep_px = 3.0;
constexpr double kKnown_px = 0.36;  // beyond, the response is not known
constexpr int kGains = 3;           // place and gain depend on one another
constexpr double kSame_px = 2e-4;   // effect of a gain that has not changed

}  // namespace

PhaseMatch::PhaseMatch(const Phase& phase, const WindowSums& sums, int radius) noexcept
    : phase_(phase), n_pixels_((2.0 * radius + 2.0) * (2.0 * radius + 2.0)) {
  const double mean = sums.sum / n_pixels_;
  step_ = {phase.px_per_unit * (sums.step_u - phase.sum_step_u * mean),
           phase.px_per_unit * (sums.step_v - phase.sum_step_v * mean)};
  along_ = phase.grey_per_unit * (sums.texture - phase.sum_texture * mean);
  contrast2_ = sums.square - mean * sums.sum;
}

double PhaseMatch::contrast() const noexcept { return std::sqrt(contrast2_ / phase_.square); }

bool PhaseMatch::locate(double gain) noexcept {
  gain_ = gain;
  for (int k = 0; k < kGains; ++k) {
    const Vector2 step{step_.u / gain_, step_.v / gain_};
    if (!(std::abs(step.u) <= kKnown_px) || !(std::abs(step.v) <= kKnown_px)) {
      const double way = length(step), share = way > kLongestStep_px ? kLongestStep_px / way : 1.0;
      place_ = {share * step.u, share * step.v};
      return false;
    }
    const Vector2 by{kPlaceScale * step.u, kPlaceScale * step.v};
    place_ = {phase_.place_u.of(by), phase_.place_v.of(by)};
    const double next = along_ / phase_.similarity.of({kPlaceScale * place_.u, kPlaceScale * place_.v});
    if (!(next > 0.0)) return false;
    const double change = std::abs(next - gain_) * std::max(std::abs(step.u), std::abs(step.v));
    gain_ = next;
    if (change < kSame_px * next) break;
  }
  return true;
}

TemplateMatch PhaseMatch::judge() const noexcept {
  const double explained =
      along_ * along_ / phase_.square +
      gain_ * gain_ * std::max(0.0, phase_.aside.of({kPlaceScale * place_.u, kPlaceScale * place_.v}));
  const double left = std::max(0.0, contrast2_ - explained);
  TemplateMatch match;
  match.residual_unit = 1.0 / (n_pixels_ - kParameters);
  match.residual = left * match.residual_unit;
  match.correlation = contrast2_ > 0.0 ? std::sqrt(1.0 - left / contrast2_) : 0.0;
  return match;
}

}  // namespace core
