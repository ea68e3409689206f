#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "firmware_app/report/pictures/pictures.h"

namespace app {

// Position of one channel on the structure.
struct ModePlace {
  std::size_t channel = 0;
  double along_px = 0.0;          // position of the region's centre in the image, along the structure
  double u_px = 0.0, v_px = 0.0;  // the centre
  double direction_u = 1.0, direction_v = 0.0;
  std::string name;
  bool is_base = false;
};

// The structure's line in the image. Regions with two axes make two lines: u and v.
struct ModeLayout {
  bool upright = true;    // spread over v more than over u
  bool in_image = false;  // true: every place is the centre of a region; false: evenly spaced in order
  std::vector<ModePlace> lines[2];
  double low_px = std::numeric_limits<double>::infinity(), high_px = -std::numeric_limits<double>::infinity();

  // One entry per position along the structure, in order: for names and grid lines.
  [[nodiscard]] std::vector<ModePlace> every_place() const;
};

[[nodiscard]] ModeLayout mode_layout(const PictureInputs& inputs);

}  // namespace app
