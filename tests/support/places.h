#pragma once

#include <string>

namespace tests {

// Absolute. Known only to places.cpp: all other tests compile to the same code in any folder, so that a
// compiler cache serves all clones.
[[nodiscard]] std::string program(const std::string& name);      // of this build: "hovermodal", "hovermodald"
[[nodiscard]] std::string source_path(const std::string& path);  // from the top of the sources

}  // namespace tests
