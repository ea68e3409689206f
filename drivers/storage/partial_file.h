#pragma once

#include <string>
#include <string_view>

namespace drivers {

// A file is written under another name and gets its own when its bytes are on the disk: a reader finds the old file or
// the whole new one, also after a loss of power.
inline constexpr std::string_view kPartialExtension = ".partial";
[[nodiscard]] inline std::string partial_path(const std::string& path) { return path + std::string(kPartialExtension); }

// Opens a new file for writing, never what a link of that name points to. Negative: errno says why.
[[nodiscard]] int open_new_file(const char* path) noexcept;

// Waits until what was written is on the disk. True also for what cannot be synchronised (a pipe, a device, some file
// systems). An interrupted call is repeated. False: errno says why.
[[nodiscard]] bool sync_to_disk(int descriptor) noexcept;

}  // namespace drivers
