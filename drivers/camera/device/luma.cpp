#include "drivers/camera/device/luma.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>

#include <jpeglib.h>

namespace drivers {

namespace {

std::size_t bytes_per_pixel(PixelLayout layout) noexcept {
  switch (layout) {
    case PixelLayout::kGray8:
      return 1;
    case PixelLayout::kGray10:
    case PixelLayout::kGray12:
    case PixelLayout::kGray16:
    case PixelLayout::kYuyv:
    case PixelLayout::kUyvy:
      return 2;
    case PixelLayout::kRgb24:
    case PixelLayout::kBgr24:
      return 3;
    case PixelLayout::kMjpeg:
      break;
  }
  return 0;
}

void shift_row(const std::uint8_t* row, std::size_t width, unsigned shift, std::uint8_t* luma) noexcept {
  for (std::size_t u = 0; u < width; ++u) {
    const auto value = static_cast<unsigned>(row[2 * u]) | static_cast<unsigned>(row[2 * u + 1]) << 8U;
    luma[u] = static_cast<std::uint8_t>(value >> shift);
  }
}

void pick_row(const std::uint8_t* row, std::size_t width, std::uint8_t* luma) noexcept {
  for (std::size_t u = 0; u < width; ++u) luma[u] = row[2 * u];
}

// 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601) in 16-bit fixed point.
void weigh_row(const std::uint8_t* row, std::size_t width, std::size_t red, std::uint8_t* luma) noexcept {
  const std::size_t blue = 2 - red;
  for (std::size_t u = 0; u < width; ++u) {
    const std::uint8_t* p = row + 3 * u;
    luma[u] = static_cast<std::uint8_t>((19595U * p[red] + 38470U * p[1] + 7471U * p[blue] + 32768U) >> 16U);
  }
}

}  // namespace

// libjpeg reports an error by a callback that must not return: longjmp leads back to `decode`, across C frames only.
struct LumaReader::Jpeg {
  jpeg_decompress_struct decoder{};
  jpeg_error_mgr errors{};
  std::jmp_buf broken{};

  Jpeg() {
    decoder.err = jpeg_std_error(&errors);
    decoder.client_data = this;
    errors.error_exit = [](j_common_ptr common) { std::longjmp(static_cast<Jpeg*>(common->client_data)->broken, 1); };
    errors.emit_message = [](j_common_ptr, int) {};  // otherwise warnings go to stderr
    errors.output_message = [](j_common_ptr) {};
    if (setjmp(broken) != 0) throw std::bad_alloc();  // nothing else fails in it
    jpeg_create_decompress(&decoder);
  }
  ~Jpeg() { jpeg_destroy_decompress(&decoder); }
  Jpeg(const Jpeg&) = delete;
  Jpeg& operator=(const Jpeg&) = delete;

  [[nodiscard]] bool decode(const std::uint8_t* bytes, std::size_t n_bytes, std::size_t width, std::size_t height,
                            std::uint8_t* luma) noexcept {
    if (setjmp(broken) != 0) {
      jpeg_abort_decompress(&decoder);
      return false;
    }
    errors.num_warnings = 0;
    jpeg_mem_src(&decoder, bytes, n_bytes);
    if (jpeg_read_header(&decoder, TRUE) != JPEG_HEADER_OK || decoder.image_width != width ||
        decoder.image_height != height) {
      jpeg_abort_decompress(&decoder);
      return false;
    }
    decoder.out_color_space = JCS_GRAYSCALE;  // luma is a separate component of a JPEG: nothing is converted
    jpeg_start_decompress(&decoder);
    while (decoder.output_scanline < decoder.output_height) {
      JSAMPROW row = luma + decoder.output_scanline * width;
      jpeg_read_scanlines(&decoder, &row, 1);
    }
    jpeg_finish_decompress(&decoder);
    return errors.num_warnings == 0;  // libjpeg completes a truncated image with gray and warns
  }
};

LumaReader::LumaReader(PixelLayout layout, int width_px, int height_px, std::size_t stride_bytes)
    : layout_(layout),
      width_(static_cast<std::size_t>(width_px)),
      height_(static_cast<std::size_t>(height_px)),
      stride_(stride_bytes != 0 ? stride_bytes : row_bytes(layout, width_px)),
      jpeg_(layout == PixelLayout::kMjpeg ? std::make_unique<Jpeg>() : nullptr) {}

LumaReader::~LumaReader() = default;
LumaReader::LumaReader(LumaReader&&) noexcept = default;
LumaReader& LumaReader::operator=(LumaReader&&) noexcept = default;

LumaStatus LumaReader::read(const std::uint8_t* bytes, std::size_t n_bytes, std::uint8_t* luma) noexcept {
  if (jpeg_) {
    return jpeg_->decode(bytes, n_bytes, width_, height_, luma) ? LumaStatus::kOk : LumaStatus::kDamaged;
  }
  if (n_bytes < stride_ * (height_ - 1) + width_ * bytes_per_pixel(layout_)) return LumaStatus::kShort;
  if (layout_ == PixelLayout::kGray8 && stride_ == width_) {
    std::memcpy(luma, bytes, width_ * height_);
    return LumaStatus::kOk;
  }
  for (std::size_t v = 0; v < height_; ++v, bytes += stride_, luma += width_) {
    switch (layout_) {
      case PixelLayout::kGray8:
        std::memcpy(luma, bytes, width_);
        break;
      case PixelLayout::kGray10:
        shift_row(bytes, width_, 2, luma);
        break;
      case PixelLayout::kGray12:
        shift_row(bytes, width_, 4, luma);
        break;
      case PixelLayout::kGray16:
        shift_row(bytes, width_, 8, luma);
        break;
      case PixelLayout::kYuyv:
        pick_row(bytes, width_, luma);
        break;
      case PixelLayout::kUyvy:
        pick_row(bytes + 1, width_, luma);
        break;
      case PixelLayout::kRgb24:
        weigh_row(bytes, width_, 0, luma);
        break;
      case PixelLayout::kBgr24:
        weigh_row(bytes, width_, 2, luma);
        break;
      case PixelLayout::kMjpeg:
        break;
    }
  }
  return LumaStatus::kOk;
}

std::size_t row_bytes(PixelLayout layout, int width_px) noexcept {
  return bytes_per_pixel(layout) * static_cast<std::size_t>(width_px);
}

}  // namespace drivers
