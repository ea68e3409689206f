#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firmware_app/config/config.h"

namespace tests {

inline constexpr const char* kGood = R"(method: paper
camera:
  driver: file
  source: clip.mp4
  rate_hz: 29.97
regions:
  - {name: base, rect: [10, 20, 30, 40], role: base}
  - name: roof
    rect: [1, 2, 3, 4]
    axis: both
scale: {known_length_mm: 300, from: [0, 0], to: [100, 0]}
)";

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// The reason why the configuration is refused; empty = it is accepted.
inline std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    static_cast<void>(app::parse_config(text, "a.yaml", overrides));
  } catch (const app::ConfigError& error) {
    return error.what();
  }
  return {};
}

inline std::string refusal_with(const std::string& from, const std::string& to) {
  return refusal(replaced(kGood, from, to));
}
inline std::string refusal_of_line(const std::string& line) { return refusal(std::string(kGood) + line + "\n"); }

}  // namespace tests
