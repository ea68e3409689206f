#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/places.h"

namespace tests {

// Folder of the measured data: HOVERMODAL_DATA, else ../shared/data beside the project where it exists, else data in
// the project, where tools/data.sh brings them.
inline std::filesystem::path measured_data_path() {
  const char* const named = std::getenv("HOVERMODAL_DATA");
  if (named != nullptr && *named != '\0') return named;
  const std::filesystem::path shared = tests::source_path("../shared/data");
  return std::filesystem::exists(shared) ? shared : std::filesystem::path(tests::source_path("data"));
}

}  // namespace tests

// At the top of a test that reads `file`, a path below the measured data.
#define SKIP_WITHOUT_MEASURED(file)                                                            \
  if (!std::filesystem::exists(tests::measured_data_path() / (file))) {                        \
    GTEST_SKIP() << "no data at " << (tests::measured_data_path() / (file)).lexically_normal() \
                 << " (tools/data.sh brings them)";                                            \
  }
