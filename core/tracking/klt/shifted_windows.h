#pragma once

#include <array>

#include "core/tracking/klt/float_window.h"
#include "core/tracking/klt/phase.h"

namespace core {

// Shifts of a template, in sixths of a pixel: the phases, and nodes to either side of each, up to the next phase.
inline constexpr int kShiftsPerPhase = 2, kShiftsPerPixel = kShiftsPerPhase * kPhasesPerPixel;
inline constexpr int kReach = kShiftsPerPhase;
inline constexpr int kNodes = 2 * kReach + 1;
inline constexpr int kFirstShift = -kReach, kLastShift = kShiftsPerPixel - kShiftsPerPhase + kReach;
inline constexpr int kShifts = kLastShift - kFirstShift + 1;

// A window with the margin that the gradient needs.
inline constexpr int kWideRadius = kWindowRadius + kGradientRadius;
inline constexpr int kWide = 2 * kWideRadius + 2;
inline constexpr int kWideRow = 28;
using WideWindow = std::array<std::array<float, kWideRow>, kWide>;

// The windows of a template that is moved by fractions of a pixel: T(x - shift), T less `level`.
class ShiftedWindows {
 public:
  ShiftedWindows(const Patch& patch, int radius, float level) noexcept;

  // Shifts in sixths of a pixel, kFirstShift ... kLastShift.
  void window(int shift_u, int shift_v, FloatWindow& out) const noexcept;
  void wide(int shift_u, int shift_v, WideWindow& out) const noexcept;

 private:
  using Across = std::array<std::array<float, kWideRow>, kPatch>;  // the patch, moved along its rows

  int radius_;
  alignas(64) std::array<Across, kShifts> across_;
};

}  // namespace core
