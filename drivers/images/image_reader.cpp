#include "drivers/images/image_reader.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "drivers/storage/limits.h"
#include "drivers/storage/regular_file.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

using Imread = cv::Mat(const std::string& path, int flags);
// cv::imread(std::string const&, int) by the Itanium C++ ABI, which all Debian architectures follow.
constexpr const char* kSymbol = "_ZN2cv6imreadERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEi";

Imread* load_imread() {
  // The library reads its bound when it is loaded; its own default is 2^30 pixels.
  ::setenv("OPENCV_IO_MAX_IMAGE_PIXELS", std::to_string(Limits::kImagePixels).c_str(), 1);
  // libjpeg keeps the whole of a progressive image beside its pixels; in thousands of bytes.
  ::setenv("JPEGMEM", std::to_string(Limits::kJpegBytes / 1000).c_str(), 1);
  void* library = dlopen(HOVERMODAL_IMGCODECS, RTLD_NOW | RTLD_LOCAL);
  void* symbol = library == nullptr ? nullptr : dlsym(library, kSymbol);
  if (symbol == nullptr) {
    throw std::runtime_error("still images cannot be read: " HOVERMODAL_IMGCODECS
                             " is not installed (apt install libopencv-imgcodecs406); or convert them to a clip");
  }
  return reinterpret_cast<Imread*>(symbol);
}

struct ImageSize {
  std::uint64_t width = 0, height = 0, bytes_a_pixel = 1;  // width 0: unknown
  std::uint64_t beside = 0;                                // bytes that the decoder keeps beside the pixels
};

std::uint64_t big_endian(std::span<const unsigned char> bytes) {
  std::uint64_t value = 0;
  for (const unsigned char byte : bytes) value = value << 8U | byte;
  return value;
}

// Signature, length and name of the first chunk, width, height, bits of a sample, kind of colour.
ImageSize size_of_png(std::span<const unsigned char, 26> head) {
  const unsigned samples = head[25] == 0 ? 1 : head[25] == 2 || head[25] == 3 ? 3 : 4;
  return {big_endian(head.subspan(16, 4)), big_endian(head.subspan(20, 4)), samples * (head[24] == 16 ? 2U : 1U)};
}

// Of a progressive image libjpeg keeps all coefficients, two bytes each, of parts that may be subsampled. `parts`:
// three bytes each, the second the horizontal and vertical share.
std::uint64_t coefficient_bytes(const ImageSize& image, std::span<const unsigned char> parts) {
  std::uint64_t sum = 0, most = 1;
  for (std::size_t i = 1; i < parts.size(); i += 3) {
    const std::uint64_t share = std::uint64_t{parts[i] / 16U} * (parts[i] % 16U);
    sum += share, most = std::max(most, share);
  }
  return image.width * image.height / most * sum * 2;
}

// Segments of a mark and a length, up to the frame's head: bits of a sample, height, width, number of parts, the parts.
ImageSize size_of_jpeg(std::FILE* file, const std::string& path) {
  constexpr std::size_t kFixed = 10, kMostParts = 4;
  std::array<unsigned char, kFixed + 3 * kMostParts> head{};
  for (long at = 2; std::fseek(file, at, SEEK_SET) == 0;) {
    if (read_bytes(file, head.data(), head.size(), path) < kFixed || head[0] != 0xFF) return {};
    const bool is_frame = head[1] >= 0xC0 && head[1] <= 0xCF && head[1] != 0xC4 && head[1] != 0xC8 && head[1] != 0xCC;
    const std::span<const unsigned char> all(head);
    if (is_frame) {
      ImageSize image{big_endian(all.subspan(7, 2)), big_endian(all.subspan(5, 2)), head[9]};
      const std::size_t n_parts = std::min<std::size_t>(head[9], kMostParts);
      if (head[1] == 0xC2) image.beside = coefficient_bytes(image, all.subspan(kFixed, 3 * n_parts));
      return image;
    }
    at += head[1] == 0xFF ? 1 : 2 + static_cast<long>(big_endian(all.subspan(2, 2)));
  }
  return {};
}

// Called before the image library is loaded. For formats other than PNG and JPEG the library's own limit holds.
void require_usable_size(const std::string& path) {
  constexpr std::string_view kPng("\x89PNG\r\n\x1a\n", 8), kJpeg("\xFF\xD8\xFF", 3);
  const FileHandle file = open_regular_file(path, "name an image");
  std::array<unsigned char, 26> head{};
  if (read_bytes(file.get(), head.data(), head.size(), path) != head.size()) return;
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  const ImageSize image = text.starts_with(kPng)    ? size_of_png(head)
                          : text.starts_with(kJpeg) ? size_of_jpeg(file.get(), path)
                                                    : ImageSize{};
  if (image.width == 0) return;
  const std::string size = "has " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels";
  if (image.height > Limits::kImagePixels / image.width) {
    throw std::runtime_error(size + ", more than " + std::to_string(Limits::kImagePixels) +
                             " (8192 x 8192): reduce it");
  }
  if (image.bytes_a_pixel != 0 && image.height > Limits::kImageBytes / image.bytes_a_pixel / image.width) {
    throw std::runtime_error(size + " of " + std::to_string(image.bytes_a_pixel) + " bytes, more than " +
                             std::to_string(Limits::kImageBytes) +
                             " bytes: convert it to 8 bits without alpha, or reduce it");
  }
  if (image.beside > Limits::kJpegBytes) {
    throw std::runtime_error(size + " in a progressive JPEG, which takes " + std::to_string(image.beside) +
                             " bytes beside them, more than " + std::to_string(Limits::kJpegBytes) +
                             ": save it as baseline, or reduce it");
  }
}

}  // namespace

cv::Mat read_image(const std::string& path, int flags) {
  try {
    require_usable_size(path);
    static Imread* const imread = load_imread();
    return imread(path, flags);
  } catch (const FileError&) {  // a pipe, a device, or nothing
    return {};
  } catch (const cv::Exception&) {  // only a size beyond the bound is thrown; what is damaged gives an empty image
    throw std::runtime_error("is larger than " + std::to_string(Limits::kImagePixels) +
                             " pixels (8192 x 8192), or its size is damaged: reduce it");
  }
}

}  // namespace drivers
