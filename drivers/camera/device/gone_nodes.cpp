#include "drivers/camera/device/gone_nodes.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace drivers {

namespace {

template <class Take>
void for_open_nodes(Take take) {
  constexpr std::array kNodes = {"/dev/video", "/dev/media", "/dev/v4l-subdev"};
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored)) {
    const std::string target = std::filesystem::read_symlink(entry.path(), ignored).string();
    const auto is_prefix = [&](const char* node) { return target.starts_with(node); };
    if (std::any_of(kNodes.begin(), kNodes.end(), is_prefix)) take(std::atoi(entry.path().filename().c_str()), target);
  }
}

}  // namespace

std::vector<int> open_camera_nodes() {
  std::vector<int> found;
  for_open_nodes([&](int descriptor, const std::string&) { found.push_back(descriptor); });
  return found;
}

std::vector<int> open_nodes_that_are_gone() {
  constexpr const char* kGone = " (deleted)";  // proc(5)
  std::vector<int> found;
  for_open_nodes([&](int descriptor, const std::string& target) {
    if (target.ends_with(kGone)) found.push_back(descriptor);
  });
  return found;
}

void let_go(const std::vector<int>& descriptors) noexcept {
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (null < 0) return;
  for (const int descriptor : descriptors) dup3(null, descriptor, O_CLOEXEC);
  close(null);
}

}  // namespace drivers
