#include "tools/hovermodal/named_file.h"

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "drivers/storage/printable.h"

namespace tools {

constexpr std::size_t kPathShown = 500;

void require_free(const std::string& path, bool force) {
  std::error_code error;
  if (path.empty() || force || !std::filesystem::exists(path, error)) return;
  throw std::invalid_argument(drivers::printable(path, kPathShown) +
                              ": exists; name another file, or --force to replace it");
}

void add_force_option(drivers::Command& command, bool& force) {
  command.flag("--force", force, "Replace an existing file");
}

}  // namespace tools
