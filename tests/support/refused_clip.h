#pragma once

#include <exception>
#include <filesystem>
#include <string>

#include "drivers/camera/recording/file_camera.h"

namespace test_support {

// What FileCamera says of a source that it refuses; "accepted" where it does not.
inline std::string refusal(const std::filesystem::path& source, drivers::FileCameraConfig config = {}) {
  config.source = source.string();
  try {
    const drivers::FileCamera camera(config);
  } catch (const std::exception& thrown) {
    return thrown.what();
  }
  return "accepted";
}

}  // namespace test_support
