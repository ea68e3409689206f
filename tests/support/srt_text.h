#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace test_support {

struct SrtFrame {
  double t_s = 0.0;  // by the camera's clock, after midnight
  double exposure_s = 0.001, focal_length = 240.0;
};

// Subtitles in the format of DJI's newer cameras, one block per frame, with their clock in microseconds.
inline std::string srt_text(const std::vector<SrtFrame>& frames) {
  std::string out;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto micro = std::llround(frames[i].t_s * 1e6);
    out += fmt::format(
        "{}\n00:00:00,000 --> 00:00:00,000\n<font size=\"36\">SrtCnt : {}, DiffTime : 40ms\n"
        "2022-08-07 10:{:02}:{:02},{:03},{:03}\n[iso : 100] [shutter : 1/{:.1f}] [fnum : 280] [focal_len : {:.0f}] "
        "</font>\n\n",
        i + 1, i + 1, micro / 60'000'000, micro / 1'000'000 % 60, micro / 1000 % 1000, micro % 1000,
        1.0 / frames[i].exposure_s, frames[i].focal_length);
  }
  return out;
}

}  // namespace test_support
