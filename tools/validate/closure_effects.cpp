#include "tools/validate/closure_effects.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "core/simulation/camera/camera_motion.h"
#include "core/simulation/camera/recorded_motion.h"
#include "core/simulation/structure/periodic_signal.h"
#include "core/types/constants.h"
#include "tools/validate/drawn_scene.h"

namespace tools {
namespace {

using core::kDegPerRad;
using core::kNan;
using core::simulation::Scene;

void set_roll(Scene& s, double size) { s.hover.roll_rms_rad = size / kDegPerRad; }
void set_pitch(Scene& s, double size) { s.hover.pitch_rms_rad = size / kDegPerRad; }
void set_yaw(Scene& s, double size) { s.hover.yaw_rms_rad = size / kDegPerRad; }

// Roll as a Gaussian process between 5 and 10 Hz, as a recorded attitude, because the hover's own roll ends at 5 Hz.
void set_fast_roll(Scene& s, double size) {
  constexpr double kLow_hz = 5.0, kHigh_hz = 10.0, kRate_hz = 200.0, kMargin_s = 60.0;
  Draw draw(s.seed, "fast_roll");
  const double period_s = s.duration_s + kMargin_s;
  std::vector<std::complex<double>> amplitude(static_cast<std::size_t>(kHigh_hz * period_s) + 1);
  const auto first = static_cast<std::size_t>(kLow_hz * period_s);
  const double each = size / kDegPerRad / std::sqrt(static_cast<double>(amplitude.size() - first));
  for (std::size_t k = first; k < amplitude.size(); ++k) {
    const double re = draw.gaussian();
    amplitude[k] = each * std::complex<double>(re, draw.gaussian());
  }
  const core::simulation::PeriodicSignal roll(amplitude, period_s,
                                              core::simulation::grid_size(period_s, 20.0 * kHigh_hz));
  const auto flight = std::make_shared<core::simulation::RecordedMotion>();
  flight->rate_hz = kRate_hz;
  std::optional<core::simulation::RecordedPath> before;
  if (s.flight != nullptr) before.emplace(*s.flight);
  for (double t_s = 0.0; t_s < s.duration_s + 1.0; t_s += 1.0 / kRate_hz) {
    flight->roll_rad.push_back(roll.at(t_s));
    if (!before) continue;
    flight->x_mm.push_back(before->at(0, t_s));
    flight->y_mm.push_back(before->at(1, t_s));
    flight->z_mm.push_back(before->at(2, t_s));
  }
  s.flight = flight;
}

// The true readout is larger or smaller than the declared one, by the seed; always within 0 ... 1 frame.
void set_readout(Scene& s, double size) {
  const double declared = s.camera.readout_s * s.camera.rate_hz;
  double sign = Draw(s.seed, "readout_error").sign();
  if (declared + sign * size < 0.0 || declared + sign * size > 1.0) sign = declared > 0.5 ? -1.0 : 1.0;
  s.camera.readout_s = std::clamp(declared + sign * size, 0.0, 1.0) / s.camera.rate_hz;
}
void set_radial(Scene& s, double size) {
  s.camera.lens.model = core::simulation::LensParameters::Model::kRadialTangential;
  s.camera.lens.k[0] = Draw(s.seed, "radial").sign() * size;
}
void set_tangential(Scene& s, double size) {
  const double angle = 2.0 * std::numbers::pi * Draw(s.seed, "tangential").uniform(0.0, 1.0);
  s.camera.lens.model = core::simulation::LensParameters::Model::kRadialTangential;
  s.camera.lens.k[2] = size * std::cos(angle);
  s.camera.lens.k[3] = size * std::sin(angle);
}
void set_locking(Scene& s, double size) { s.tracks.pixel_locking_px = size; }
void set_rotor(Scene& s, double size) {
  Draw draw(s.seed, "rotor");
  s.rotor.frequency_hz = draw.log_uniform(60.0, 140.0);
  s.rotor.roll_rms_rad = size / kDegPerRad;
  s.rotor.pitch_rms_rad = draw.uniform(0.3, 0.9) * size / kDegPerRad;
  s.rotor.yaw_rms_rad = draw.uniform(0.3, 0.9) * size / kDegPerRad;
}

// The camera's true motion in this record, about its mean; axis: index in CameraMotion::deviation().
template <std::size_t kAxis>
std::vector<KnownValue> turned_deg(const Scene& s, const Scene&) {
  const core::simulation::CameraMotion camera(s);
  const auto n = static_cast<double>(s.n_frames());
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t k = 0; k < s.n_frames(); ++k) {
    const double turn = camera.deviation(static_cast<double>(k) / s.camera.rate_hz)[kAxis];
    sum += turn, squares += turn * turn;
  }
  return {{"rms", kDegPerRad * std::sqrt(squares / n - sum / n * sum / n)}};
}
std::vector<KnownValue> added_readout(const Scene& s, const Scene& declared) {
  return {{"added readout", (s.camera.readout_s - declared.camera.readout_s) * s.camera.rate_hz}};
}
std::vector<KnownValue> k1(const Scene& s, const Scene&) { return {{"k1", s.camera.lens.k[0]}}; }
std::vector<KnownValue> p1_p2(const Scene& s, const Scene&) {
  return {{"p1", s.camera.lens.k[2]}, {"p2", s.camera.lens.k[3]}};
}
// core/simulation/track_generator.cpp: sin(phase) + 0.25 sin(2 phase + 0.5).
std::vector<KnownValue> locking_waves(const Scene& s, const Scene&) {
  const double px = s.tracks.pixel_locking_px;
  return {{"sin", px}, {"cos", 0.0}, {"sin 2", 0.25 * px * std::cos(0.5)}, {"cos 2", 0.25 * px * std::sin(0.5)}};
}
std::vector<KnownValue> rotor_hz(const Scene& s, const Scene&) {
  const double hz = s.rotor.frequency_hz, rate_hz = s.camera.rate_hz;
  return {{"frequency", hz}, {"apparent frequency", std::abs(hz - std::round(hz / rate_hz) * rate_hz)}};
}

}  // namespace

const std::vector<HiddenEffect>& hidden_effects() {
  static const std::vector<HiddenEffect> all{
      {"camera roll", "camera roll", 5.0, 0.01, set_roll, turned_deg<5>},
      {"camera pitch", "camera pitch", 0.15, 0.05, set_pitch, turned_deg<3>},
      {"camera yaw", "camera yaw", 3.0, 0.05, set_yaw, turned_deg<4>},
      {"roll above 5 Hz", "camera roll", 5.0, 0.01, set_fast_roll, turned_deg<5>},
      {"readout time", "readout time", 0.9, 0.1, set_readout, added_readout},
      {"radial distortion", "radial distortion", 0.5, 0.01, set_radial, k1},
      {"tangential distortion", "tangential distortion", 0.05, 0.001, set_tangential, p1_p2},
      {"pixel locking", "pixel locking", 0.5, 0.005, set_locking, locking_waves},
      {"rotor line", "rotor line", 0.5, 0.001, set_rotor, rotor_hz},
  };
  return all;
}

const HiddenEffect& effect_named(const std::string& name) {
  const auto& all = hidden_effects();
  const auto found = std::find_if(all.begin(), all.end(), [&](const HiddenEffect& e) { return e.name == name; });
  if (found == all.end()) throw std::invalid_argument("no effect is called " + name);
  return *found;
}

ParameterErrors parameter_errors(const std::vector<core::closure::ClosureStep>& steps, const std::string& called,
                                 const std::vector<KnownValue>& truth) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const auto step = std::find_if(steps.begin(), steps.end(), [&](const auto& s) { return s.effect == called; });
  if (step == steps.end()) return {kNan, kNan};
  ParameterErrors out{0.0, kNan};
  for (const KnownValue& known : truth) {
    const auto stated = std::find_if(step->parameters.begin(), step->parameters.end(),
                                     [&](const auto& p) { return p.name == known.name; });
    const bool judged = stated != step->parameters.end() && stated->sigma && *stated->sigma > 0.0;
    const double off = stated == step->parameters.end() ? kNan : stated->value - known.value;
    if (&known == &truth.front()) out.first = off;
    out.worst_sigmas = std::max(out.worst_sigmas, judged ? std::abs(off) / *stated->sigma : kInfinite);
  }
  return out;
}

}  // namespace tools
