#include "drivers/images/image_reader.h"

#include <dlfcn.h>

#include <stdexcept>

namespace drivers {
namespace {

using Imread = cv::Mat(const std::string& path, int flags);
// cv::imread(std::string const&, int) by the Itanium C++ ABI, which all Debian architectures follow.
constexpr const char* kSymbol = "_ZN2cv6imreadERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEi";

Imread* load_imread() {
  void* library = dlopen(HOVERMODAL_IMGCODECS, RTLD_NOW | RTLD_LOCAL);
  void* symbol = library == nullptr ? nullptr : dlsym(library, kSymbol);
  if (symbol == nullptr) {
    throw std::runtime_error("still images cannot be read: " HOVERMODAL_IMGCODECS
                             " is not installed (apt install libopencv-imgcodecs406); or convert them to a clip");
  }
  return reinterpret_cast<Imread*>(symbol);
}

}  // namespace

cv::Mat read_image(const std::string& path, int flags) {
  static Imread* const imread = load_imread();
  return imread(path, flags);
}

}  // namespace drivers
