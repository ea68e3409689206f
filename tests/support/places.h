#pragma once

#include <string>

namespace tests {

// Absolute. Known to places.cpp alone: every other test compiles to the same in whatever folder it stands, so that a
// compiler cache serves all clones.
[[nodiscard]] std::string program(const std::string& name);      // of this build: "hovermodal", "hovermodald"
[[nodiscard]] std::string source_path(const std::string& path);  // from the top of the sources

}  // namespace tests
