#pragma once

#include <span>
#include <string_view>

namespace tools {

// A file of the page, compiled in.
struct PageFile {
  std::string_view name, text;
};

[[nodiscard]] std::span<const PageFile> page_files() noexcept;

}  // namespace tools
