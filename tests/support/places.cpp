#include "tests/support/places.h"

namespace tests {

std::string program(const std::string& name) { return HOVERMODAL_BIN_DIR "/" + name; }

std::string source_path(const std::string& path) { return HOVERMODAL_SOURCE_DIR "/" + path; }

}  // namespace tests
