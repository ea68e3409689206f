#include "tools/hovermodal/clip_source.h"

#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace tools {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kOptionOfKey = {
    {{"camera.rate_hz", "--rate-hz"}, {"camera.decoder_mb", "--decoder-mb"}}};

std::string with_options(std::string message) {
  for (const auto& [key, option] : kOptionOfKey) {
    for (std::size_t at = message.find(key); at != std::string::npos; at = message.find(key, at + option.size()))
      message.replace(at, key.size(), option);
  }
  return message;
}

template <class Make>
auto made(Make make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(with_options(error.what()));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(with_options(error.what()));
  }
}

}  // namespace

void add_decoder_option(drivers::Command& command, int& decoder_mb) {
  command.option("--decoder-mb", decoder_mb, "Memory for decoding, in MB; 8K, and 5K of 10 bits, take more")
      .range(drivers::kLeastDecoderMb, drivers::kMostDecoderMb)
      .show_default();
}

std::unique_ptr<drivers::Camera> open_clip_camera(const drivers::CameraOptions& options) {
  return made([&] { return drivers::make_camera(options); });
}

std::unique_ptr<drivers::FrameSource> open_clip(const std::string& path, int decoder_mb) {
  return made([&] { return drivers::open_frame_source(path, decoder_mb); });
}

}  // namespace tools
