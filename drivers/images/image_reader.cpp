#include "drivers/images/image_reader.h"

#include <dlfcn.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <opencv2/core.hpp>
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

// States the size in words; for other formats the library's own bound holds.
void require_usable_png(const std::string& path) {
  constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
  const FileHandle file = open_regular_file(path, "name an image");
  std::array<char, 26> head{};  // signature, length and name of the first chunk, width, height, bits, kind of colour
  if (read_bytes(file.get(), head.data(), head.size(), path) != head.size()) return;
  if (std::string_view(head.data(), 8) != kSignature) return;
  const auto number = [&head](std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8U | static_cast<unsigned char>(head[i]);
    return value;
  };
  const std::uint64_t width = number(16), height = number(20);
  const std::uint64_t bytes_a_pixel = (head[25] == 0                    ? 1U
                                       : head[25] == 2 || head[25] == 3 ? 3U
                                                                        : 4U) *
                                      (head[24] == 16 ? 2U : 1U);
  if (width == 0) return;
  const std::string size = "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels";
  if (height > Limits::kImagePixels / width)
    throw std::runtime_error(size + ", more than " + std::to_string(Limits::kImagePixels) +
                             " (8192 x 8192): reduce it");
  if (height > Limits::kImageBytes / bytes_a_pixel / width)
    throw std::runtime_error(size + " of " + std::to_string(bytes_a_pixel) + " bytes, more than " +
                             std::to_string(Limits::kImageBytes) +
                             " bytes: convert it to 8 bits without alpha, or reduce it");
}

}  // namespace

cv::Mat read_image(const std::string& path, int flags) {
  try {
    require_usable_png(path);  // before the library, which takes 30 MB
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
