#include "core/simulation/injected/validation.h"

#include <stdexcept>
#include <string>

namespace core::simulation {
namespace {

void require_range(const std::string& what, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument("simulation: " + what + " is " + std::to_string(value) + "; give a value from " +
                              std::to_string(low) + " to " + std::to_string(high));
}

void validate_camera(const Scene& s) {
  const TailedHoverParameters& tails = s.tailed_hover;
  for (std::size_t i = 0; i < 3; ++i) {
    require_range("tailed hover (mm rms)", tails.rms_mm[i], 0.0, 1e5);
    require_range("tailed rotation (rad rms)", tails.rms_rad[i], 0.0, 0.1);
    for (const double hz : {tails.corner_hz[i], tails.turn_corner_hz[i]})
      require_range("corner of the tailed hover (Hz)", hz, 0.001, 50.0);
    for (const double order : {tails.order[i], tails.turn_order[i]})
      require_range("order of the tailed hover", order, 2.0, 24.0);
    require_range("vibration of the gimbal (rad rms)", s.vibration.rms_rad[i], 0.0, 0.01);
    require_range("vibration of the gimbal (mm rms)", s.vibration.rms_mm[i], 0.0, 100.0);
  }
  require_range("middle of the gimbal's vibration (Hz)", s.vibration.centre_hz, 0.1, 100.0);
  require_range("width of the gimbal's vibration (Hz)", s.vibration.width_hz, 0.001, 50.0);
  require_range("gain of the stabiliser", s.stabiliser.gain, 0.0, 1.0);
  require_range("corner of the stabiliser (Hz)", s.stabiliser.corner_hz, 0.001, 50.0);
  require_range("lag of the stabiliser (s)", s.stabiliser.lag_s, 0.0, 1.0);
  require_range("focus breathing (rms)", s.breathing.rms, 0.0, 0.05);
  require_range("corner of the focus breathing (Hz)", s.breathing.corner_hz, 0.001, 10.0);
  for (const double px : s.breathing.centre_px)
    require_range("centre of the focus breathing (px)", px, -8192.0, 8192.0);
}

void validate_oscillator(const std::string& of, const OscillatorParameters& oscillator) {
  require_range("frequency of " + of + " (Hz)", oscillator.frequency_hz, 0.05, 50.0);
  require_range("damping of " + of, oscillator.damping_ratio, 1e-4, 1.0);
}

}  // namespace

void validate_injected(const Scene& s) {
  validate_camera(s);
  require_range("shimmer (px rms)", s.shimmer.rms_px, 0.0, 20.0);
  require_range("inner scale of the shimmer (px)", s.shimmer.inner_px, 1.0, 1e4);
  require_range("outer scale of the shimmer (px)", s.shimmer.outer_px, s.shimmer.inner_px, 1e5);
  for (const double px_s : s.shimmer.drift_px_s) require_range("drift of the shimmer (px/s)", px_s, -1e4, 1e4);
  require_range("boiling of the shimmer (px/s)", s.shimmer.boiling_px_s, 0.0, 1e4);
  validate_oscillator("the flapping part", s.flap);
  require_range("body with the flapping part", s.flap.body, 0, s.n_bodies() - 1);
  require_range("start of the flapping part", s.flap.from_share, 0.0, 1.0);
  require_range("flapping part (mm rms)", s.flap.rms_mm, 0.0, 1e3);
  validate_oscillator("rocking", s.rocking);
  require_range("rocking (rad rms)", s.rocking.rms_rad, 0.0, 0.1);
  validate_oscillator("torsion", s.torsion);
  require_range("torsion (rad rms)", s.torsion.rms_rad, 0.0, 0.1);
  validate_oscillator("the background's sway", s.sway);
  require_range("the background's sway (mm rms)", s.sway.rms_mm, 0.0, 1e4);
}

}  // namespace core::simulation
