#include "core/simulation/injected/stabiliser.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace core::simulation {
namespace {

constexpr double kRate_hz = 500.0, kBefore_s = 30.0, kAfter_s = 1.0;  // long enough for the filter's transient to decay

// Bilinear transform of s / (s + w).
std::vector<double> high_passed(const std::vector<double>& x, double corner_hz) {
  const double half = std::numbers::pi * corner_hz / kRate_hz, keep = (1.0 - half) / (1.0 + half);
  std::vector<double> out(x.size(), 0.0);
  for (std::size_t k = 1; k < x.size(); ++k) out[k] = keep * out[k - 1] + 0.5 * (1.0 + keep) * (x[k] - x[k - 1]);
  return out;
}

}  // namespace

Stabiliser::Stabiliser(const StabiliserParameters& p, const CameraMotion& camera, double alpha_px, double depth_mm,
                       double duration_s)
    : later_s_(kBefore_s - p.lag_s), works_(p.gain > 0.0) {
  if (!works_) return;
  std::vector<double> u, v, turn;
  const auto n = static_cast<std::size_t>((kBefore_s + duration_s + kAfter_s) * kRate_hz);
  for (std::size_t k = 0; k < n; ++k) {
    const auto moved = camera.deviation(static_cast<double>(k) / kRate_hz - kBefore_s);
    u.push_back(p.gain * alpha_px * (moved[0] / depth_mm + moved[4]));
    v.push_back(p.gain * alpha_px * (moved[1] / depth_mm - moved[3]));
    turn.push_back(p.gain * moved[5]);
  }
  u_ = UniformSpline(high_passed(u, p.corner_hz), kRate_hz);
  v_ = UniformSpline(high_passed(v, p.corner_hz), kRate_hz);
  turn_ = UniformSpline(high_passed(turn, p.corner_hz), kRate_hz);
}

Stabiliser::Warp Stabiliser::at(double t_s) const noexcept {
  if (!works_) return {};
  const double at_s = t_s + later_s_;
  return {u_.at(at_s), v_.at(at_s), turn_.at(at_s)};
}

}  // namespace core::simulation
