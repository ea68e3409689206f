#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/simulation/render/texture.h"

namespace core::simulation {

// A line: the pixels that a rolling shutter exposes at once, a row or a column. Working memory for one line, allocated
// once and reused; every array has one spare block at its end.
struct RenderLine {
  explicit RenderLine(int length, std::size_t n_cells);

  void begin() noexcept;  // nothing drawn yet

  std::vector<float> light, background;             // light of the line; mean of the background over the exposure
  std::vector<float> plate, cover;                  // of the current plate: grey levels, share of each pixel covered
  std::array<std::vector<float>, 2> open;           // per instant: share of each pixel not covered by a plate so far
  std::array<std::vector<double>, 2> ray_x, ray_y;  // by instant
  std::vector<Texture::Cell> cells, other_cells;
  std::vector<std::uint8_t> pixels;
};

// Adds the current plate to pixels begin .. end - 1, behind all plates added before, for one instant of the exposure.
// `weight` is the share of that instant in the exposure; so much light is moved from the background to the plate. Exact
// if one straight edge crosses a pixel; edges of two plates in the same pixel are treated as independent.
void lay_plate(RenderLine& line, int begin, int end, std::size_t instant, float weight) noexcept;

}  // namespace core::simulation
