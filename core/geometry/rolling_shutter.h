#pragma once

#include "core/types/frame.h"

namespace core {

// Instant at which a pixel is seen, relative to the start of exposure of row 0 (core/geometry/METHOD.md): T_r v / h for
// a sensor read downwards. `readout_s` is signed; up and left reverse the sign; left and right are along u.
struct ReadoutModel {
  double readout_s = 0.0;
  ReadoutDirection direction = ReadoutDirection::kDown;
  int width_px = 1;
  int height_px = 1;

  // Position along the readout, 0 at row (column) 0, 1 at the last one; for reversed directions 0 .. -1.
  [[nodiscard]] double fraction(double u_px, double v_px) const noexcept {
    switch (direction) {
      case ReadoutDirection::kDown:
        return v_px / height_px;
      case ReadoutDirection::kUp:
        return -v_px / height_px;
      case ReadoutDirection::kRight:
        return u_px / width_px;
      case ReadoutDirection::kLeft:
        return -u_px / width_px;
    }
    return 0.0;
  }
  // Size of the image along the readout.
  [[nodiscard]] int extent_px() const noexcept { return reads_rows(direction) ? height_px : width_px; }
  [[nodiscard]] double delay_s(double u_px, double v_px) const noexcept { return readout_s * fraction(u_px, v_px); }
};

}  // namespace core
