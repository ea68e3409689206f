#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/camera/recording/av_handles.h"

namespace drivers {

// Decoded picture -> 8-bit gray, width x height, row-major, no padding, in one pass. The luma plane is used directly:
// full range copied, video range (16 .. 235) stretched to 0 .. 255 and clipped, of 9 to 12 bits the upper eight;
// RGB by 0.299 R + 0.587 G + 0.114 B. Built for one pixel format and range.
class PictureLuma {
 public:
  // Returns why pictures of this format are refused, e.g. "an alpha channel"; empty: they are not.
  [[nodiscard]] static std::string unwanted(AVPixelFormat format);

  explicit PictureLuma(const AVFrame& first);
  [[nodiscard]] bool fits(const AVFrame& frame) const noexcept;  // same format and range as the first
  void read(const AVFrame& frame, std::uint8_t* gray) noexcept;

 private:
  // Position of component c of pixel x in a row of plane `plane`: x * step + offset.
  struct Component {
    int plane = 0, step = 1, offset = 0;
  };
  enum class Way : std::uint8_t { kCopy, kStretch, kTable, kWideTable, kColour, kPalette };

  void make_table(int depth, int shift);

  AVPixelFormat format_;
  bool full_range_;
  bool big_endian_ = false;
  Way way_ = Way::kCopy;
  std::array<Component, 3> components_{};  // luma, or red, green, blue
  std::vector<std::uint8_t> table_;        // indexed by the stored value
};

}  // namespace drivers
