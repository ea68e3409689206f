#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "drivers/camera/recording/clip_telemetry.h"

namespace drivers {

namespace {

constexpr double kMostSpeed_rad_s = 100.0;

const GpmfStream* find(const GpmfPayload& payload, const char* key) {
  for (const GpmfStream& stream : payload.streams) {
    if (stream.key == key) return &stream;
  }
  return nullptr;
}

// Values of every row of one stream, spread evenly over its payload; non-finite and non-positive values are left out.
std::vector<TimedValue> positive_values(std::span<const TimedPayload> payloads, const char* key, double unit) {
  std::vector<TimedValue> out;
  for (const TimedPayload& one : payloads) {
    const GpmfStream* stream = find(one.payload, key);
    if (stream == nullptr) continue;
    const auto n = static_cast<double>(stream->n_rows());
    for (std::size_t i = 0; i < stream->n_rows(); ++i) {
      const double value = stream->values[i * stream->n_columns] * unit;
      if (std::isfinite(value) && value > 0.0)
        out.push_back({one.t_s + one.duration_s * static_cast<double>(i) / n, value});
    }
  }
  return out;
}

// The exposure is stated once per frame: the camera's clock at the first frame of every payload gives the rate.
void describe_frames(std::span<const TimedPayload> payloads, ClipTelemetry& out) {
  std::vector<double> frame, clock_s;
  double n_frames = 0.0;
  for (const TimedPayload& one : payloads) {
    const GpmfStream* stream = find(one.payload, "SHUT");
    if (stream == nullptr) continue;
    if (stream->first_s) {
      frame.push_back(n_frames), clock_s.push_back(*stream->first_s);
      out.clock_s.push_back({one.t_s, *stream->first_s});
    }
    n_frames += static_cast<double>(stream->n_rows());
  }
  const auto n = static_cast<double>(frame.size());
  if (frame.size() < 3) return;
  double mean_k = 0.0, mean_t = 0.0, kk = 0.0, kt = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < frame.size(); ++i) mean_k += frame[i] / n, mean_t += clock_s[i] / n;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    kk += (frame[i] - mean_k) * (frame[i] - mean_k);
    kt += (frame[i] - mean_k) * (clock_s[i] - mean_t);
  }
  if (!(kk > 0.0) || !(kt > 0.0)) return;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const double off_s = clock_s[i] - mean_t - kt / kk * (frame[i] - mean_k);
    squares += off_s * off_s;
  }
  out.frame_rate_hz = kk / kt;
  out.frame_jitter_s = std::sqrt(squares / n);
}

struct Axis {
  std::size_t place = 0;  // index in x, y, z
  double sign = 1.0;
};

// "XzY" means that the columns are +X, -Z, +Y. Cameras that state nothing write Z, X, Y.
std::optional<std::array<Axis, 3>> axes_of(const GpmfStream& stream) {
  const std::string text = stream.orientation_in.empty() ? "ZXY" : stream.orientation_in;
  if (text.size() != 3) return {};
  std::array<Axis, 3> axes{};
  std::array<bool, 3> seen{};
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_small = text[i] >= 'x' && text[i] <= 'z';
    const char large = is_small ? static_cast<char>(text[i] - 'x' + 'X') : text[i];
    if (large < 'X' || large > 'Z') return {};
    axes[i] = {static_cast<std::size_t>(large - 'X'), is_small ? -1.0 : 1.0};
    seen[axes[i].place] = true;
  }
  if (!(seen[0] && seen[1] && seen[2])) return {};
  return axes;
}

using Quaternion = std::array<double, 4>;

Quaternion product(const Quaternion& a, const Quaternion& b) noexcept {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

Quaternion rotation(const std::array<double, 3>& angle_rad) noexcept {
  const double size =
      std::sqrt(angle_rad[0] * angle_rad[0] + angle_rad[1] * angle_rad[1] + angle_rad[2] * angle_rad[2]);
  const double by = size > 1e-12 ? std::sin(0.5 * size) / size : 0.5;
  return {std::cos(0.5 * size), by * angle_rad[0], by * angle_rad[1], by * angle_rad[2]};
}

// The rates of the gyro are taken as constant from one sample to the next.
void integrate_gyro(std::span<const TimedPayload> payloads, ClipTelemetry& out) {
  Quaternion attitude{1.0, 0.0, 0.0, 0.0};
  std::array<double, 3> rate_rad_s{};
  for (const TimedPayload& one : payloads) {
    const GpmfStream* gyro = find(one.payload, "GYRO");
    if (gyro == nullptr || gyro->n_columns != 3 || !(one.duration_s > 0.0)) continue;
    const auto axes = axes_of(*gyro);
    if (!axes) continue;
    for (std::size_t i = 0; i < gyro->n_rows(); ++i) {
      const double t_s = one.t_s + one.duration_s * static_cast<double>(i) / static_cast<double>(gyro->n_rows());
      if (!out.attitude.empty()) {
        const double dt_s = t_s - out.attitude.back().t_s;
        if (!(dt_s > 0.0)) continue;
        attitude = product(attitude, rotation({rate_rad_s[0] * dt_s, rate_rad_s[1] * dt_s, rate_rad_s[2] * dt_s}));
      }
      for (std::size_t column = 0; column < 3; ++column) {
        const double value = gyro->values[3 * i + column];
        const Axis& axis = (*axes)[column];
        if (std::abs(value) < kMostSpeed_rad_s) rate_rad_s[axis.place] = axis.sign * value;  // false for NaN
      }
      out.attitude.push_back({t_s, attitude});
      out.attitude_from = "gyro";
    }
  }
}

}  // namespace

ClipTelemetry telemetry_of(std::span<const TimedPayload> payloads) {
  ClipTelemetry out;
  out.from = "GPMF";
  for (const TimedPayload& one : payloads) {
    if (one.payload.device.empty()) continue;
    out.from = "GPMF of " + one.payload.device;
    break;
  }
  constexpr double kMilli = 1e-3;
  out.exposure_s = positive_values(payloads, "SHUT", 1.0);
  out.readout_s = positive_values(payloads, "SROT", kMilli);
  describe_frames(payloads, out);
  integrate_gyro(payloads, out);
  return out;
}

}  // namespace drivers
