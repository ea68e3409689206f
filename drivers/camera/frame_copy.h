#pragma once

#include <cstring>

#include "core/types/frame.h"

namespace drivers {

// A frame of a driver's own buffer -> the caller's slot, of which the pixels are never reallocated; t_taken_ns is the
// caller's. False, and nothing is written: the slot has another size.
[[nodiscard]] inline bool copy_frame(const core::Frame& from, core::Frame& slot) noexcept {
  if (slot.pixels.size() != from.pixels.size()) return false;
  std::memcpy(slot.pixels.data(), from.pixels.data(), from.pixels.size());
  slot.sequence = from.sequence;
  slot.t_start_ns = from.t_start_ns;
  slot.exposure_ns = from.exposure_ns;
  slot.gap_before = from.gap_before;
  slot.width_px = from.width_px;
  slot.height_px = from.height_px;
  return true;
}

}  // namespace drivers
