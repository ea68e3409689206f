#include "drivers/camera/recording/picture_luma.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace drivers {

namespace {

constexpr int kMostBits = 12;  // 16-bit formats often hold 12 bits unscaled, and would come out black

bool is_full_range(const AVFrame& frame) noexcept {
  const std::string_view name = av_get_pix_fmt_name(static_cast<AVPixelFormat>(frame.format));
  return frame.color_range == AVCOL_RANGE_JPEG || name.starts_with("yuvj") || name.starts_with("gray");
}

// 16 -> 0, 235 -> 255, rounded down: floor(x 255 / 219) = x + floor(x 12 / 73), exact for x <= 239.
std::uint8_t stretched(std::uint8_t value) noexcept {
  const auto above = static_cast<std::uint16_t>(std::max<int>(value, 16) - 16);
  const auto more = static_cast<std::uint16_t>((static_cast<std::uint32_t>(above) * 10774U) >> 16U);
  return static_cast<std::uint8_t>(std::min<int>(above + more, 255));
}

std::uint8_t gray_of(int red, int green, int blue) noexcept {  // rounded as in OpenCV
  return static_cast<std::uint8_t>((red * 9798 + green * 19235 + blue * 3735 + (1 << 14)) >> 15);
}

}  // namespace

std::string PictureLuma::unwanted(AVPixelFormat format) {
  const AVPixFmtDescriptor* desc = av_pix_fmt_desc_get(format);
  if (desc == nullptr) return "an unknown pixel format";
  if (format == AV_PIX_FMT_PAL8) return {};
  const std::string name = desc->name;
  if ((desc->flags & AV_PIX_FMT_FLAG_ALPHA) != 0) return "an alpha channel";
  const bool is_rgb = (desc->flags & AV_PIX_FMT_FLAG_RGB) != 0;
  const int depth = desc->comp[0].depth;
  if (depth == 16) return desc->nb_components == 1 ? "16 bit gray pixels" : "16 bits per channel";
  const std::uint64_t strange = AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER | AV_PIX_FMT_FLAG_FLOAT |
                                AV_PIX_FMT_FLAG_BITSTREAM | AV_PIX_FMT_FLAG_PAL;
  const bool is_odd = (desc->flags & strange) != 0 || name.starts_with("xyz") || depth < 8;
  if (is_odd || (is_rgb ? depth != 8 : depth > kMostBits)) return fmt::format("pixels of the format {}", name);
  return {};
}

PictureLuma::PictureLuma(const AVFrame& first)
    : format_(static_cast<AVPixelFormat>(first.format)), full_range_(is_full_range(first)) {
  const AVPixFmtDescriptor& desc = *av_pix_fmt_desc_get(format_);
  for (std::size_t c = 0; c < std::min<std::size_t>(desc.nb_components, 3); ++c) {
    components_[c] = {desc.comp[c].plane, desc.comp[c].step, desc.comp[c].offset};
  }
  big_endian_ = (desc.flags & AV_PIX_FMT_FLAG_BE) != 0;
  const int depth = desc.comp[0].depth;
  if (format_ == AV_PIX_FMT_PAL8) {
    way_ = Way::kPalette;
    table_.resize(256);
  } else if ((desc.flags & AV_PIX_FMT_FLAG_RGB) != 0) {
    way_ = Way::kColour;
  } else if (depth > 8) {
    way_ = Way::kWideTable;
    make_table(depth, desc.comp[0].shift);
  } else if (components_[0].step != 1) {
    way_ = Way::kTable;
    make_table(8, 0);
  } else {
    way_ = full_range_ ? Way::kCopy : Way::kStretch;
  }
}

// Covers every value that can be stored, so that no picture can index outside the table.
void PictureLuma::make_table(int depth, int shift) {
  table_.resize(depth > 8 ? 65536 : 256);
  const int most = (1 << depth) - 1;
  const int black = 16 << (depth - 8), range = 219 << (depth - 8);
  for (std::size_t stored = 0; stored < table_.size(); ++stored) {
    const int value = std::min(static_cast<int>(stored) >> shift, most);
    if (depth == 8) {
      table_[stored] = full_range_ ? static_cast<std::uint8_t>(value) : stretched(static_cast<std::uint8_t>(value));
    } else {
      const int gray = full_range_ ? (value * 255 + most / 2) / most : ((value - black) * 255 + range / 2) / range;
      table_[stored] = static_cast<std::uint8_t>(std::clamp(gray, 0, 255));
    }
  }
}

bool PictureLuma::fits(const AVFrame& frame) const noexcept {
  return frame.format == format_ && is_full_range(frame) == full_range_;
}

void PictureLuma::read(const AVFrame& frame, std::uint8_t* gray) noexcept {
  if (way_ == Way::kPalette) {
    for (std::size_t i = 0; i < 256; ++i) {
      std::uint32_t colour = 0;  // 0xAARRGGBB, native order
      std::memcpy(&colour, frame.data[1] + 4 * i, 4);
      table_[i] = gray_of(static_cast<int>(colour >> 16U & 0xffU), static_cast<int>(colour >> 8U & 0xffU),
                          static_cast<int>(colour & 0xffU));
    }
  }
  const auto width = static_cast<std::size_t>(frame.width);
  const auto row_of = [&](std::size_t c, int v) {
    const auto plane = static_cast<std::size_t>(components_[c].plane);
    return frame.data[plane] + static_cast<std::ptrdiff_t>(v) * frame.linesize[plane] + components_[c].offset;
  };
  const auto step_of = [&](std::size_t c) { return static_cast<std::size_t>(components_[c].step); };
  for (int v = 0; v < frame.height; ++v, gray += width) {
    const std::uint8_t* row = row_of(0, v);
    const std::size_t step = step_of(0);
    switch (way_) {
      case Way::kCopy:
        std::memcpy(gray, row, width);
        break;
      case Way::kStretch:
        for (std::size_t u = 0; u < width; ++u) gray[u] = stretched(row[u]);
        break;
      case Way::kTable:
      case Way::kPalette:
        for (std::size_t u = 0; u < width; ++u) gray[u] = table_[row[u * step]];
        break;
      case Way::kWideTable: {
        const std::size_t low = big_endian_ ? 1 : 0;
        for (std::size_t u = 0; u < width; ++u) {
          gray[u] = table_[row[u * step + low] | static_cast<std::size_t>(row[u * step + 1 - low]) << 8U];
        }
        break;
      }
      case Way::kColour: {
        const std::uint8_t *green = row_of(1, v), *blue = row_of(2, v);
        for (std::size_t u = 0; u < width; ++u)
          gray[u] = gray_of(row[u * step], green[u * step_of(1)], blue[u * step_of(2)]);
        break;
      }
    }
  }
}

}  // namespace drivers
