#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace drivers {

// Memory layout of a device's image, as far as its luma is concerned.
enum class PixelLayout : std::uint8_t {
  kGray8,   // one byte a pixel, at the start of the buffer: gray, and the planar Y'CbCr formats
  kGray10,  // two bytes a pixel, little endian, the value in the low 10, 12 or all bits
  kGray12,
  kGray16,
  kYuyv,   // two bytes a pixel, luma in the even ones
  kUyvy,   // luma in the odd ones
  kRgb24,  // three bytes in this order
  kBgr24,
  kMjpeg,  // one JPEG an image
};

enum class LumaStatus : std::uint8_t {
  kOk,
  kShort,    // fewer bytes than the image requires
  kDamaged,  // a JPEG that does not decode, or has another size
};

// Bytes of a device's buffer -> 8-bit luma, width x height, row-major, no padding. Built once; `read` allocates nothing
// except for MJPEG, where libjpeg allocates and frees its working memory for every image.
class LumaReader {
 public:
  // stride_bytes: from one row to the next; 0 = no padding. Unused by kMjpeg.
  LumaReader(PixelLayout layout, int width_px, int height_px, std::size_t stride_bytes);
  ~LumaReader();
  LumaReader(LumaReader&&) noexcept;
  LumaReader& operator=(LumaReader&&) noexcept;

  // `luma` has width x height bytes; undefined unless the result is kOk.
  [[nodiscard]] LumaStatus read(const std::uint8_t* bytes, std::size_t n_bytes, std::uint8_t* luma) noexcept;

 private:
  struct Jpeg;

  PixelLayout layout_;
  std::size_t width_;
  std::size_t height_;
  std::size_t stride_;
  std::unique_ptr<Jpeg> jpeg_;  // null unless kMjpeg
};

// Bytes of one row without padding; 0 for kMjpeg.
[[nodiscard]] std::size_t row_bytes(PixelLayout layout, int width_px) noexcept;

}  // namespace drivers
