#include "drivers/host/memory_left.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

namespace drivers {
namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

std::uint64_t available_to_all(const fs::path& root) {
  std::ifstream in(root / "proc/meminfo");
  std::uint64_t kibibytes = 0;
  for (std::string key, line; in >> key; std::getline(in, line)) {
    if (key == "MemAvailable:" && in >> kibibytes) return kibibytes * 1024;
  }
  return kUnknown;
}

std::optional<std::uint64_t> number_of(const fs::path& path) {
  std::ifstream in(path);
  std::uint64_t value = 0;
  return in >> value ? std::optional(value) : std::nullopt;  // "max": none
}

// The smallest over the levels of control group v2, because a level above may have a tighter limit.
std::uint64_t left_in_group(const fs::path& root) {
  std::ifstream in(root / "proc/self/cgroup");
  std::string line;
  while (std::getline(in, line) && !line.starts_with("0::/")) continue;
  if (!line.starts_with("0::/")) return kUnknown;
  std::uint64_t left = kUnknown;
  const fs::path top = root / "sys/fs/cgroup";
  for (fs::path group = fs::path(line.substr(4));; group = group.parent_path()) {
    const auto limit = number_of(top / group / "memory.max"), used = number_of(top / group / "memory.current");
    if (limit && used) left = std::min(left, *limit - std::min(*limit, *used));
    if (group.empty()) return left;
  }
}

std::uint64_t left_of_limit(int which, std::uint64_t used_bytes) {
  struct rlimit limit {};
  if (::getrlimit(static_cast<__rlimit_resource>(which), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return kUnknown;
  return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used_bytes);
}

}  // namespace

std::uint64_t memory_left(const std::string& root_path) {
  const fs::path root(root_path);
  std::ifstream in(root / "proc/self/statm");
  std::uint64_t total = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
  in >> total >> resident >> shared >> text >> library >> data;
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return std::min({available_to_all(root), left_in_group(root), left_of_limit(RLIMIT_AS, total * page),
                   left_of_limit(RLIMIT_DATA, data * page)});
}

}  // namespace drivers
