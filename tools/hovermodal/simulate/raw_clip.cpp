#include "tools/hovermodal/simulate/raw_clip.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace tools {
namespace {

// The rate is a fraction; other tools know 30000:1001 as well as 29970030:1000000.
constexpr double kRateDenominator = 1e6;

}  // namespace

RawClip::RawClip(const std::string& path, int width_px, int height_px, double rate_hz)
    : file_(path), frame_bytes_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)) {
  fmt::format_to(std::back_inserter(file_.buffer()), "YUV4MPEG2 W{} H{} F{}:{:.0f} Ip A1:1 Cmono XCOLORRANGE=FULL\n",
                 width_px, height_px, std::llround(rate_hz * kRateDenominator), kRateDenominator);
}

void RawClip::write(const std::uint8_t* pixels) {
  drivers::append_text(file_.buffer(), "FRAME\n");
  file_.buffer().append(pixels, pixels + frame_bytes_);
  if (!file_.end_line()) file_.commit();  // throws with the reason
}

}  // namespace tools
