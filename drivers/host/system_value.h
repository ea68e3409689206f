#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drivers {

// Small files of /proc and /sys, as the kernel writes them.

// First line; empty if it cannot be read.
[[nodiscard]] std::string system_line(const std::filesystem::path& path);
// The finite number with which it begins.
[[nodiscard]] std::optional<double> system_number(const std::filesystem::path& path);
// Entries of a folder whose name begins with `prefix`; empty if it cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> system_entries(const std::filesystem::path& folder,
                                                                const std::string& prefix);

}  // namespace drivers
