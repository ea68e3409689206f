#pragma once

#include <span>
#include <string_view>

namespace tools {

class WebServer;

// A file of a page, compiled in: the server reads no files.
struct PageFile {
  std::string_view name, text;
};

[[nodiscard]] std::span<const PageFile> ground_page() noexcept;   // tools/ground
[[nodiscard]] std::span<const PageFile> regions_page() noexcept;  // tools/regions

// Serves them under their names, index.html as "/".
void add_page(WebServer& server, std::span<const PageFile> files);

}  // namespace tools
