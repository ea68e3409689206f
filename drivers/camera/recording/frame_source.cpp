#include "drivers/camera/recording/frame_source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <opencv2/core/utils/logger.hpp>
#include <stdexcept>

extern "C" {
#include <libavutil/log.h>
}

#include "drivers/camera/device_missing.h"
#include "drivers/camera/recording/image_folder_source.h"
#include "drivers/camera/recording/video_source.h"

namespace drivers {

namespace fs = std::filesystem;

namespace {

fs::file_status look_at(const std::string& path) {
  if (path.empty()) {
    throw DeviceMissing("camera.source is empty: name a video file or a folder of images");
  }
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    throw DeviceMissing(fmt::format("{}: no such file or folder: check camera.source", path));
  }
  if (error) throw std::runtime_error(fmt::format("{}: {}: check camera.source", path, error.message()));
  return status;
}

}  // namespace

std::unique_ptr<FrameSource> open_frame_source(const std::string& path, int decoder_mb) {
  const fs::file_status status = look_at(path);
  const bool is_folder = fs::is_directory(status);
  if (!is_folder && !fs::is_regular_file(status)) {
    throw std::runtime_error(
        fmt::format("{}: neither a file nor a folder: the file driver reads a video file or a folder of images", path));
  }
  if (faccessat(AT_FDCWD, path.c_str(), is_folder ? R_OK | X_OK : R_OK, AT_EACCESS) != 0) {
    throw std::runtime_error(fmt::format("{}: no permission to read it: try chmod a+r{}", path, is_folder ? "x" : ""));
  }
  silence_media_libraries();
  return is_folder ? open_image_folder(path) : open_video(path, decoder_mb);
}

core::ReadoutDirection turn_clockwise(core::ReadoutDirection direction, int degrees) noexcept {
  using enum core::ReadoutDirection;
  constexpr std::array kClockwise = {kDown, kLeft, kUp, kRight};
  std::size_t at = 0;
  while (at < kClockwise.size() && kClockwise[at] != direction) ++at;
  const int quarter_turns = ((degrees / 90) % 4 + 4) % 4;
  return kClockwise[(at + static_cast<std::size_t>(quarter_turns)) % kClockwise.size()];
}

void require_usable_size(const std::string& file, int width_px, int height_px) {
  if (width_px >= kMinImagePx && height_px >= kMinImagePx) return;
  throw std::runtime_error(fmt::format("{}: image is {} x {} px: at least {} x {} px are needed to track anything",
                                       file, width_px, height_px, kMinImagePx, kMinImagePx));
}

void silence_media_libraries() {
  static std::once_flag once;
  std::call_once(once, [] {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    av_log_set_level(AV_LOG_QUIET);
  });
}

}  // namespace drivers
