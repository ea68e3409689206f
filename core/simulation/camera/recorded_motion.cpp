#include "core/simulation/camera/recorded_motion.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "core/spectrum/real_fft.h"
#include "core/types/constants.h"

namespace core::simulation {
namespace {

constexpr double kMmPerM = 1e3;
constexpr double kFade_s = 1.0;
constexpr std::size_t kLeastSamples = 4;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

void require(bool ok, const std::string& what, double value, const std::string& advice) {
  if (!ok) throw std::invalid_argument("recorded flight: " + what + " is " + number(value) + "; " + advice);
}

void require_series(const std::vector<double>& series, std::size_t n, const char* name) {
  require(series.size() == n, std::string("number of samples of ") + name, static_cast<double>(series.size()),
          "all series must be equally long, " + std::to_string(n));
  for (const double value : series) require(std::isfinite(value), name, value, "give finite samples");
}

void validate(const core::FlightPath& path) {
  require(path.rate_hz > 0.0 && std::isfinite(path.rate_hz), "rate of the path (Hz)", path.rate_hz,
          "give a positive one");
  require(path.n_samples() >= kLeastSamples, "number of samples of the path", static_cast<double>(path.n_samples()),
          "give a longer stretch");
  require_series(path.north_mm, path.n_samples(), "north");
  require_series(path.east_mm, path.n_samples(), "east");
  require_series(path.up_mm, path.n_samples(), "up");
}

double last_s(std::size_t n, double rate_hz) { return static_cast<double>(n - 1) / rate_hz; }

void validate(const core::FlightAttitude& attitude, const core::FlightPath& path, bool with_accelerations) {
  const std::size_t n = attitude.n_samples();
  require(attitude.rate_hz > 0.0 && std::isfinite(attitude.rate_hz), "rate of the attitude (Hz)", attitude.rate_hz,
          "give a positive one");
  require(n >= kLeastSamples, "number of samples of the attitude", static_cast<double>(n), "give a longer stretch");
  require_series(attitude.pitch_rad, n, "pitch");
  require_series(attitude.yaw_rad, n, "yaw");
  require_series(attitude.roll_rad, n, "roll");
  if (with_accelerations) {
    require_series(attitude.x_m_s2, n, "the acceleration along x");
    require_series(attitude.y_m_s2, n, "the acceleration along y");
    require_series(attitude.z_m_s2, n, "the acceleration along z");
  }
  const double has_s = last_s(n, attitude.rate_hz), wanted_s = last_s(path.n_samples(), path.rate_hz);
  if (has_s < wanted_s - 1.0 / path.rate_hz) {
    throw std::invalid_argument("recorded flight: the attitude covers " + number(attitude.from_s) + " to " +
                                number(attitude.from_s + has_s) + " s, " + number(has_s) + " s of the " +
                                number(wanted_s) + " s of the path (" + number(path.from_s) + " to " +
                                number(path.from_s + wanted_s) + " s); choose a stretch that it covers, or none");
  }
}

struct Accelerations {
  std::vector<double> forward, left, up;
};

// Rotates the sensor's axes to the level frame by roll and pitch and subtracts gravity.
Accelerations levelled(const core::FlightAttitude& attitude) {
  Accelerations out;
  for (std::size_t i = 0; i < attitude.n_samples(); ++i) {
    const double roll = attitude.mean_roll_rad + attitude.roll_rad[i];
    const double pitch = attitude.mean_pitch_rad + attitude.pitch_rad[i];
    const double y = attitude.y_m_s2[i] * std::cos(roll) - attitude.z_m_s2[i] * std::sin(roll);
    const double z = attitude.y_m_s2[i] * std::sin(roll) + attitude.z_m_s2[i] * std::cos(roll);
    out.forward.push_back(attitude.x_m_s2[i] * std::cos(pitch) + z * std::sin(pitch));
    out.left.push_back(y);
    out.up.push_back(-attitude.x_m_s2[i] * std::sin(pitch) + z * std::cos(pitch) - kStandardGravity_m_s2);
  }
  return out;
}

void add(std::vector<double>& to, const std::vector<double>& what, double factor) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * what[i];
}

std::vector<double> scaled(const std::vector<double>& values, std::size_t n, double factor) {
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = factor * values[i];
  return out;
}

void set_position(const core::FlightPath& path, double facing_deg, double rate_hz, std::size_t n, RecordedMotion& out) {
  const double c = std::cos(facing_deg * kPi / 180.0), s = std::sin(facing_deg * kPi / 180.0);
  const UniformSpline north(path.north_mm, path.rate_hz), east(path.east_mm, path.rate_hz),
      up(path.up_mm, path.rate_hz);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    out.x_mm.push_back(-north.at(t) * s + east.at(t) * c);
    out.y_mm.push_back(-up.at(t));
    out.z_mm.push_back(north.at(t) * c + east.at(t) * s);
  }
}

// Gain from acceleration to displacement, mm per m/s^2.
double gain(double frequency_hz, double from_hz) noexcept {
  constexpr double kEdge = 0.8;
  if (frequency_hz <= kEdge * from_hz) return 0.0;
  const double w = 2.0 * kPi * frequency_hz;
  const double share = std::min(1.0, (frequency_hz / from_hz - kEdge) / (1.0 - kEdge));
  return -kMmPerM / (w * w) * 0.5 * (1.0 - std::cos(kPi * share));
}

}  // namespace

std::vector<double> displacement_mm(const std::vector<double>& acceleration_m_s2, double rate_hz, double from_hz) {
  require(rate_hz > 0.0 && from_hz > 0.0 && from_hz <= 0.4 * rate_hz, "lowest frequency of the vibration (Hz)", from_hz,
          "give more than 0 and at most 0.4 of the rate of the accelerations, " + number(rate_hz) + " Hz");
  const std::size_t n = acceleration_m_s2.size();
  require(n < (1U << 24U) && static_cast<double>(n) >= 4.0 * kFade_s * rate_hz, "number of accelerations",
          static_cast<double>(n), "give at least four seconds of them, and less than 2^24");
  double mean = 0.0;
  for (const double value : acceleration_m_s2) mean += value / static_cast<double>(n);
  const int n_fft = next_power_of_two(static_cast<int>(n));
  RealFft fft(n_fft);
  std::vector<double> x(static_cast<std::size_t>(n_fft));
  for (std::size_t i = 0; i < n; ++i) {
    const double edge_s = static_cast<double>(std::min(i, n - 1 - i)) / rate_hz;
    x[i] = (acceleration_m_s2[i] - mean) * 0.5 * (1.0 - std::cos(kPi * std::min(1.0, edge_s / kFade_s)));
  }
  std::vector<std::complex<double>> spectrum(static_cast<std::size_t>(fft.n_bins()));
  fft.forward(x, spectrum);
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    spectrum[k] *= gain(static_cast<double>(k) * rate_hz / n_fft, from_hz);
  fft.inverse(spectrum, x);
  x.resize(n);
  return x;
}

RecordedMotion make_recorded_motion(const core::FlightPath& path, const core::FlightAttitude* attitude,
                                    const FlightUse& use) {
  validate(path);
  require(std::isfinite(use.facing_deg), "facing (degrees)", use.facing_deg, "give a heading");
  require(use.gimbal_residual >= 0.0 && use.gimbal_residual <= 1.0, "residual of the gimbal", use.gimbal_residual,
          "give 0 (nothing reaches the picture) to 1 (no gimbal)");
  require(use.vibration_from_hz >= 0.0 && (attitude != nullptr || use.vibration_from_hz == 0.0),
          "lowest frequency of the vibration (Hz)", use.vibration_from_hz,
          "give 0, or a positive one together with a record of accelerations");
  RecordedMotion out;
  if (attitude == nullptr) {
    out.rate_hz = path.rate_hz;
    set_position(path, use.facing_deg, out.rate_hz, path.n_samples(), out);
    for (auto* angle : {&out.pitch_rad, &out.yaw_rad, &out.roll_rad}) angle->assign(path.n_samples(), 0.0);
    return out;
  }
  validate(*attitude, path, use.vibration_from_hz > 0.0);
  out.rate_hz = attitude->rate_hz;
  const double wanted = std::floor(last_s(path.n_samples(), path.rate_hz) * out.rate_hz + 1e-6) + 1.0;
  const std::size_t n = std::min(static_cast<std::size_t>(wanted), attitude->n_samples());
  set_position(path, use.facing_deg, out.rate_hz, n, out);
  out.pitch_rad = scaled(attitude->pitch_rad, n, -use.gimbal_residual);
  out.yaw_rad = scaled(attitude->yaw_rad, n, -use.gimbal_residual);
  out.roll_rad = scaled(attitude->roll_rad, n, use.gimbal_residual);
  if (use.vibration_from_hz == 0.0) return out;
  Accelerations a = levelled(*attitude);
  for (auto* series : {&a.forward, &a.left, &a.up}) series->resize(n);
  add(out.x_mm, displacement_mm(a.left, out.rate_hz, use.vibration_from_hz), -1.0);
  add(out.y_mm, displacement_mm(a.up, out.rate_hz, use.vibration_from_hz), -1.0);
  add(out.z_mm, displacement_mm(a.forward, out.rate_hz, use.vibration_from_hz), 1.0);
  return out;
}

RecordedPath::RecordedPath(const RecordedMotion& motion) {
  require(motion.rate_hz > 0.0 && std::isfinite(motion.rate_hz), "rate (Hz)", motion.rate_hz, "give a positive one");
  const std::array<const std::vector<double>*, 6> series{&motion.x_mm,      &motion.y_mm,    &motion.z_mm,
                                                         &motion.pitch_rad, &motion.yaw_rad, &motion.roll_rad};
  std::size_t n = 0;
  for (const auto* values : series) n = std::max(n, values->size());
  require(n >= kLeastSamples, "number of samples", static_cast<double>(n), "give a longer stretch");
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (series[i]->empty()) continue;
    require_series(*series[i], n, "an axis");
    axis_[i] = UniformSpline(*series[i], motion.rate_hz);
    double sum = 0.0;
    for (const double value : *series[i]) sum += value * value;
    rms_[i] = std::sqrt(sum / static_cast<double>(n));
  }
  duration_s_ = last_s(n, motion.rate_hz);
}

double RecordedPath::at(int axis, double t_s) const noexcept {
  return axis >= 0 && axis < 6 ? axis_[static_cast<std::size_t>(axis)].at(t_s) : 0.0;
}

}  // namespace core::simulation
