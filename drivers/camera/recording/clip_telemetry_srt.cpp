#include <algorithm>
#include <cmath>

#include "core/types/constants.h"
#include "drivers/camera/recording/clip_telemetry.h"
#include "drivers/camera/recording/time_fit.h"

namespace drivers {

namespace {

using core::kRadPerDeg;
constexpr double kFinestTick_s = 1e-3;  // a coarser clock does not determine frame times

// One block per frame: by frame numbers, or by cues shorter than a quarter of a second.
bool is_per_frame(const SrtFile& file) {
  if (file.blocks.size() < 2) return false;
  const auto n_numbered =
      std::count_if(file.blocks.begin(), file.blocks.end(), [](const SrtBlock& b) { return b.frame.has_value(); });
  if (2 * static_cast<std::size_t>(n_numbered) > file.blocks.size()) return true;
  const SrtBlock &first = file.blocks.front(), &last = file.blocks.back();
  if (!first.cue_s || !last.cue_s) return false;
  return *last.cue_s - *first.cue_s < 0.25 * static_cast<double>(file.blocks.size() - 1);
}

// The camera's clock at every block, in nanoseconds from the first. Empty: a block has no time, or time decreases.
std::vector<std::int64_t> clock_of(const SrtFile& file) {
  std::vector<std::int64_t> out;
  for (const SrtBlock& block : file.blocks) {
    if (!block.clock_s) return {};
    const std::int64_t t_ns = std::llround((*block.clock_s - *file.blocks.front().clock_s) * 1e9);
    if (!out.empty() && t_ns < out.back()) return {};
    out.push_back(t_ns);
  }
  return out;
}

// Position of a block in the video: its cue, if cues increase, otherwise the camera's clock, otherwise one second per
// block.
double place_s(const SrtFile& file, std::size_t i) {
  const SrtBlock &block = file.blocks[i], &first = file.blocks.front(), &last = file.blocks.back();
  if (block.cue_s && first.cue_s && last.cue_s && *last.cue_s > *first.cue_s) return *block.cue_s - *first.cue_s;
  if (block.clock_s && first.clock_s) return *block.clock_s - *first.clock_s;
  return static_cast<double>(i);
}

void describe_frames(const SrtFile& file, ClipTelemetry& out) {
  if (!is_per_frame(file) || file.clock_tick_s > kFinestTick_s) return;
  out.times_ns = clock_of(file);
  const TimeFit fit = fit_times(out.times_ns, file.clock_tick_s, {});
  out.frame_rate_hz = fit.rate_hz;
  out.frame_jitter_s = fit.jitter_s;
}

}  // namespace

ClipTelemetry telemetry_of(const SrtFile& file, const std::string& name) {
  ClipTelemetry out;
  out.from = name;
  out.tick_s = file.clock_tick_s;
  describe_frames(file, out);
  for (std::size_t i = 0; i < file.blocks.size(); ++i) {
    const SrtBlock& block = file.blocks[i];
    const double t_s = place_s(file, i);
    if (block.clock_s) out.clock_s.push_back({t_s, *block.clock_s});
    if (block.exposure_s) out.exposure_s.push_back({t_s, *block.exposure_s});
    if (block.focal_length) out.focal_length.push_back({t_s, *block.focal_length});
    if (block.zoom) out.zoom.push_back({t_s, *block.zoom});
    if (!block.gimbal_deg || (!out.attitude.empty() && t_s <= out.attitude.back().t_s)) continue;
    const auto& [roll, pitch, yaw] = *block.gimbal_deg;
    out.attitude.push_back({t_s, core::attitude_of(roll * kRadPerDeg, pitch * kRadPerDeg, yaw * kRadPerDeg)});
    out.attitude_from = "gimbal";
  }
  return out;
}

}  // namespace drivers
