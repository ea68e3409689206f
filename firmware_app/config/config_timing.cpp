#include "firmware_app/config/config_timing.h"

#include <fmt/format.h>

#include <cmath>

namespace app {
namespace {

constexpr double kRounding = 1e-3;                   // of times in ms, and of rates with few digits
constexpr double kFastest_ms = 0.2;                  // shortest plausible readout of a rolling shutter
constexpr double kShortest_ms = 5e-3;                // shortest plausible exposure
constexpr double kFinest = 0.01, kCoarsest = 300.0;  // plausible mm per px of anything filmed from the air or a tripod

void doubt_readout(const CameraConfig& camera, double frame_ms, std::vector<std::string>& out) {
  const double readout_ms = std::abs(camera.readout_ms);
  if (readout_ms == 0.0 || readout_ms >= kFastest_ms) return;
  out.push_back(fmt::format("camera.readout_ms = {:g}: hardly any sensor is so fast{}", camera.readout_ms,
                            1000.0 * readout_ms <= frame_ms
                                ? fmt::format("; seconds? Then it is {:g} ms", 1000.0 * camera.readout_ms)
                                : std::string()));
}

void doubt_exposure(const CameraConfig& camera, double frame_ms, std::vector<std::string>& out) {
  if (camera.exposure_ms > frame_ms * (1.0 + kRounding)) {
    out.push_back(
        fmt::format("camera.exposure_ms = {:g} is longer than a frame ({:.4g} ms); microseconds? Then it is "
                    "{:g} ms",
                    camera.exposure_ms, frame_ms, 1e-3 * camera.exposure_ms));
  } else if (camera.exposure_ms > 0.0 && camera.exposure_ms < kShortest_ms) {
    out.push_back(fmt::format("camera.exposure_ms = {:g} is 1/{:.0f} s; seconds? Then it is {:g} ms",
                              camera.exposure_ms, 1e3 / camera.exposure_ms, 1e3 * camera.exposure_ms));
  }
}

void doubt_length(double mm_per_px, std::vector<std::string>& out) {
  if (mm_per_px == 0.0 || (mm_per_px >= kFinest && mm_per_px <= kCoarsest)) return;
  const bool is_small = mm_per_px < kFinest;
  const double other = is_small ? 1e3 * mm_per_px : 1e-3 * mm_per_px;
  const bool would_fit = other >= kFinest && other <= kCoarsest;
  out.push_back(fmt::format("the known length makes a pixel {:.3g} mm{}", mm_per_px,
                            !would_fit ? ": are the length and its two ends right?"
                            : is_small ? fmt::format("; metres instead of mm? Then a pixel is {:.3g} mm", other)
                                       : fmt::format("; micrometres instead of mm? Then a pixel is {:.3g} mm", other)));
}

}  // namespace

void check_against_rate(const AppConfig& config, double rate_hz) {
  const double readout_ms = std::abs(config.camera.readout_ms), frame_ms = 1e3 / rate_hz;
  if (!(readout_ms > frame_ms * (1.0 + kRounding))) return;
  const double other_ms = 1e-3 * readout_ms;
  const std::string slip = other_ms >= kFastest_ms && other_ms <= frame_ms
                               ? fmt::format("; in microseconds? Then it is {:g} ms", 1e-3 * config.camera.readout_ms)
                               : std::string();
  throw ConfigError(fmt::format(
      "camera.readout_ms: {:g} is refused: allowed up to the time of a frame, {:.6g} ms at {:.6g} Hz: the sensor reads "
      "one frame after the other{}; or set camera.rate_hz to the rate at which the frames were filmed",
      config.camera.readout_ms, frame_ms, rate_hz, slip));
}

std::vector<std::string> doubtful_values(const AppConfig& config, double camera_rate_hz, double stated_hz,
                                         double mm_per_px) {
  std::vector<std::string> out;
  const double frame_ms = 1e3 / camera_rate_hz;
  doubt_readout(config.camera, frame_ms, out);
  doubt_exposure(config.camera, frame_ms, out);
  doubt_length(mm_per_px, out);
  constexpr double kOther = 0.02;
  if (config.camera.rate_hz > 0.0 && stated_hz > 0.0 && std::abs(config.camera.rate_hz / stated_hz - 1.0) > kOther) {
    out.push_back(
        fmt::format("camera.rate_hz = {:g}, the container states {:.6g}: right for slow motion, of which it "
                    "states the rate of playing; else leave camera.rate_hz out",
                    config.camera.rate_hz, stated_hz));
  }
  return out;
}

}  // namespace app
