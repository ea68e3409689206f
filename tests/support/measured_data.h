#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/places.h"

namespace tests {

// Folder of the measured data: HOVERMODAL_DATA, else ../shared/data beside the project.
inline std::filesystem::path measured_data_path() {
  const char* const named = std::getenv("HOVERMODAL_DATA");
  if (named != nullptr && *named != '\0') return named;
  return tests::source_path("../shared/data");
}

}  // namespace tests

// At the top of a test that reads `file`, a path below the measured data.
#define SKIP_WITHOUT_MEASURED(file)                                                                     \
  if (!std::filesystem::exists(tests::measured_data_path() / (file))) {                                 \
    GTEST_SKIP() << "no measured data at " << (tests::measured_data_path() / (file)).lexically_normal() \
                 << " (HOVERMODAL_DATA names the folder)";                                              \
  }
