#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drivers {

// One block of the subtitles that DJI's cameras write beside a video, for one frame or one second. Values that a camera
// does not state are empty.
struct SrtBlock {
  std::optional<double> cue_s;                      // start of the subtitle in the video
  std::optional<double> clock_s;                    // the camera's own clock, since 1970 as if in UTC
  std::optional<std::uint64_t> frame;               // number of the frame, as the camera counts
  std::optional<double> exposure_s;                 // shutter
  std::optional<double> focal_length;               // in the camera's own unit: mm, or tenths of mm
  std::optional<double> zoom;                       // digital: 1 = none
  std::optional<std::array<double, 3>> gimbal_deg;  // roll, pitch, yaw
};

struct SrtFile {
  std::vector<SrtBlock> blocks;
  double clock_tick_s = 1.0;  // resolution of clock_s: 1, 1e-3 or 1e-6
};

// Any text of numbered blocks, in all known layouts of DJI (FrameCnt or SrtCnt with [key : value], HOME / GPS / ISO
// lines, F/2.8, SS 160, ISO 100 ... lines). Throws std::runtime_error "NAME:LINE: what": no block, a block without any
// known value, or more blocks than Limits::kSubtitleBlocks.
[[nodiscard]] SrtFile parse_srt(std::string_view text, const std::string& name);
[[nodiscard]] SrtFile read_srt(const std::string& path);  // refuses more than Limits::kSubtitleBytes

// "FLIGHT.SRT" or "FLIGHT.srt" beside "FLIGHT.MP4"; empty: none.
[[nodiscard]] std::string find_srt(const std::string& video);

}  // namespace drivers
