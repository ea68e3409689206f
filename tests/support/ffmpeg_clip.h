#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

// Clips made by the program ffmpeg: variable times, other streams, other pixel formats.
namespace test_support {

inline void ffmpeg(const std::string& arguments) {
  const std::string command = "ffmpeg -v error -nostdin -y " + arguments;
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
}

// A noisy picture that moves, 128 x 96 px, as an input of ffmpeg: every frame differs from the one before.
inline std::string noisy_film(int n_frames, double rate_hz = 25.0, const std::string& size = "128x96") {
  return fmt::format("-f lavfi -i \"testsrc2=s={}:r={}:d={:.6f},noise=alls=12:allf=t+u:all_seed=7,format=yuv420p\"",
                     size, rate_hz, n_frames / rate_hz);
}

inline std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

constexpr const char* kH264 = "-c:v libx264 -preset veryfast -crf 18 -bf 2 -threads 1";

}  // namespace test_support
