#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/scene.h"

namespace core::simulation {

// Sensor model: white Gaussian noise, rounding, range 0 to 255. Each line of each frame starts at a random place of a
// table of noise.
// of each frame starts at a random place.
class RenderSensor {
 public:
  explicit RenderSensor(const Scene& scene);

  void expose(std::uint64_t frame, int line, const float* light, int length, std::uint8_t* pixels) const noexcept;

 private:
  std::vector<float> noise_;  // grey levels
  std::uint64_t key_;
};

}  // namespace core::simulation
