#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace core {

enum class WindowKind : std::uint8_t { kHann, kHamming, kBoxcar };

[[nodiscard]] inline std::optional<WindowKind> window_kind(std::string_view name) noexcept {
  if (name == "hann") return WindowKind::kHann;
  if (name == "hamming") return WindowKind::kHamming;
  if (name == "boxcar") return WindowKind::kBoxcar;
  return std::nullopt;
}

// All are a0 - (1 - a0) cos(2 pi t / n).
[[nodiscard]] inline double window_a0(WindowKind kind) noexcept {
  return kind == WindowKind::kBoxcar ? 1.0 : kind == WindowKind::kHann ? 0.5 : 0.54;
}

// Periodic ("DFT-even") windows, as in scipy.signal.get_window, of the length of `window`.
inline void fill_window(WindowKind kind, std::span<double> window) noexcept {
  const double a0 = window_a0(kind);
  const auto n = static_cast<double>(window.size());
  for (std::size_t t = 0; t < window.size(); ++t) {
    window[t] = a0 - (1.0 - a0) * std::cos(2.0 * std::numbers::pi * static_cast<double>(t) / n);
  }
}

[[nodiscard]] inline std::vector<double> make_window(WindowKind kind, int n) {
  std::vector<double> window(static_cast<std::size_t>(n));
  fill_window(kind, window);
  return window;
}

}  // namespace core
