#include "core/simulation/hover_motion.h"

#include <cmath>
#include <complex>
#include <cstddef>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

constexpr std::array<const char*, 6> kStreamName{"hover_x",     "hover_y",   "hover_z",
                                                 "hover_pitch", "hover_yaw", "hover_roll"};
// Room beyond the clip, so that the slow drift has forgotten itself before it repeats.
constexpr double kMargin_s = 60.0;

PeriodicSignal drift(const HoverParameters& hover, double rms, RandomStream stream, double duration_s) {
  if (rms <= 0.0) return {};
  const double period_s = 1.5 * duration_s + kMargin_s;
  std::vector<std::complex<double>> amplitude(static_cast<std::size_t>(hover.limit_hz * period_s) + 1);
  double variance = 0.0;
  for (std::size_t k = 1; k < amplitude.size(); ++k) {
    const double f = static_cast<double>(k) / period_s;
    const double density = 1.0 / (1.0 + std::pow(f / hover.corner_hz, hover.order));
    const double re = stream.gaussian();
    amplitude[k] = std::sqrt(density) * std::complex<double>(re, stream.gaussian());
    variance += density;
  }
  for (auto& a : amplitude) a *= rms / std::sqrt(variance);
  return {amplitude, period_s, grid_size(period_s, 20.0 * hover.limit_hz)};
}

}  // namespace

HoverMotion::HoverMotion(const HoverParameters& hover, std::uint64_t seed, double duration_s)
    : duration_s_(duration_s), rotates_(hover.rotates()) {
  const std::array<double, 6> rms{hover.x_rms_mm,      hover.y_rms_mm,    hover.z_rms_mm,
                                  hover.pitch_rms_rad, hover.yaw_rms_rad, hover.roll_rms_rad};
  for (std::size_t i = 0; i < signal_.size(); ++i) {
    signal_[i] = drift(hover, rms[i], RandomStream(seed, kStreamName[i]), duration_s);
  }
}

CameraPose HoverMotion::at(double t_s) const noexcept {
  CameraPose pose;
  pose.x_mm = signal_[0].at(t_s);
  pose.y_mm = signal_[1].at(t_s);
  pose.z_mm = signal_[2].at(t_s);
  if (rotates_) pose.attitude = attitude(signal_[3].at(t_s), signal_[4].at(t_s), signal_[5].at(t_s));
  return pose;
}

std::array<double, 6> HoverMotion::rms() const noexcept {
  std::array<double, 6> result{};
  for (std::size_t i = 0; i < signal_.size(); ++i) result[i] = signal_[i].rms(0.0, duration_s_);
  return result;
}

}  // namespace core::simulation
