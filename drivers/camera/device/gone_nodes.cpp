#include "drivers/camera/device/gone_nodes.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace drivers {

std::vector<int> open_nodes_that_are_gone() {
  constexpr std::array kNodes = {"/dev/video", "/dev/media", "/dev/v4l-subdev"};
  constexpr const char* kGone = " (deleted)";  // proc(5)
  std::vector<int> found;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored)) {
    const std::string target = std::filesystem::read_symlink(entry.path(), ignored).string();
    const auto is_prefix = [&](const char* node) { return target.starts_with(node); };
    if (target.ends_with(kGone) && std::any_of(kNodes.begin(), kNodes.end(), is_prefix))
      found.push_back(std::atoi(entry.path().filename().c_str()));
  }
  return found;
}

void let_go(const std::vector<int>& descriptors) noexcept {
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (null < 0) return;
  for (const int descriptor : descriptors) dup3(null, descriptor, O_CLOEXEC);
  close(null);
}

}  // namespace drivers
