#pragma once

#include "core/simulation/render/render_line.h"
#include "core/simulation/render/texture.h"

namespace core::simulation {

// Drawing for a camera that looks straight along Z: a row of pixels is then a row of the texture, cubic in each
// cell.

// Pixel u looks at x = x0 + u step, in cells, and at y_mm.
struct TextureRow {
  double y_mm, x0, step;
};

// Largest number of cells seen by `width` pixels, for any drift of the camera.
[[nodiscard]] std::size_t most_cells(int width) noexcept;

// light[u] for u in [begin, end); up to three pixels beyond `end` are overwritten.
void draw_texture_row(const Texture& texture, const TextureRow& row, int begin, int end, RenderLine& line,
                      float* light) noexcept;
// The mean of a and b, pixels 0 .. width - 1, into line.background.
void draw_background_row(const Texture& texture, const TextureRow& a, const TextureRow& b, int width,
                         RenderLine& line) noexcept;

// Share of the pixel [centre - 1/2, centre + 1/2] that lies in [low, high].
[[nodiscard]] double covered(double centre, double low, double high) noexcept;

}  // namespace core::simulation
