#pragma once

namespace core {

// A point or a step in the image, pixels; u right, v down.
struct Vector2 {
  double u = 0.0;
  double v = 0.0;
};

}  // namespace core
