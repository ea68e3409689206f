#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/simulation/render/texture.h"

namespace core::simulation {

// A line: the pixels that a rolling shutter exposes at once, a row or a column. Working memory for one, built once and
// reused; every array has a block to spare at its end.
struct RenderLine {
  explicit RenderLine(int length, std::size_t n_cells);

  void begin() noexcept;  // nothing drawn yet

  std::vector<float> light, background;    // what is seen; the background's mean over the exposure
  std::vector<float> plate, cover;         // of the plate at hand: its grey levels, the share of each pixel it covers
  std::array<std::vector<float>, 2> open;  // by instant: share of each pixel that no plate has covered yet
  std::array<std::vector<double>, 2> ray_x, ray_y;  // by instant
  std::vector<Texture::Cell> cells, other_cells;
  std::vector<std::uint8_t> pixels;
};

// Lays the plate at hand, pixels begin .. end - 1, behind all plates laid before: of the light of one instant, which
// counts `weight`, its share moves from background to plate. Exact where one straight edge crosses a pixel; where
// edges of two plates cross the same pixel they are taken as independent.
void lay_plate(RenderLine& line, int begin, int end, std::size_t instant, float weight) noexcept;

}  // namespace core::simulation
