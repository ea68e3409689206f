#include "core/simulation/render/render_row.h"

#include <algorithm>
#include <cmath>

namespace core::simulation {
namespace {

constexpr double kLargestMerge = 0.05;  // cells
constexpr int kCellsPerPixel = 4;       // at most
constexpr int kRowBlock = 4;            // pixels computed together

// The cells seen by pixels begin .. end - 1, with one spare cell on either side.
struct CellRange {
  std::int64_t first, count;
};

CellRange cells_of(const TextureRow& row, int begin, int end) noexcept {
  const auto first = static_cast<std::int64_t>(std::floor(row.x0 + begin * row.step)) - 1;
  const auto last = static_cast<std::int64_t>(std::floor(row.x0 + (end - 1) * row.step)) + 1;
  return {first, last - first + 1};
}

// Cell by cell.
void evaluate(const TextureRow& row, std::int64_t first_cell, const Texture::Cell* cells, int begin, int end,
              float* light) noexcept {
  const double pixels_per_cell = 1.0 / row.step;
  const auto slope = static_cast<float>(row.step);
  auto cell = static_cast<std::int64_t>(std::floor(row.x0 + begin * row.step));
  for (int u = begin; u < end; ++cell) {
    const float p0 = cells[cell - first_cell].p[0], p1 = cells[cell - first_cell].p[1];
    const float p2 = cells[cell - first_cell].p[2], p3 = cells[cell - first_cell].p[3];
    const double origin = row.x0 - static_cast<double>(cell);
    const int next = std::clamp(static_cast<int>(std::ceil((1.0 - origin) * pixels_per_cell)), u, end);
    for (; u < next; u += kRowBlock) {
      const auto start = static_cast<float>(origin + u * row.step);
      for (int k = 0; k < kRowBlock; ++k) {
        const float s = start + static_cast<float>(k) * slope;
        light[u + k] = p0 + s * (p1 + s * (p2 + s * p3));
      }
    }
    u = next;
  }
}

// cell(s) becomes the mean of a(s - shift) and b(s + shift): both polynomials expanded about their shifted origins.
void mean_of_shifted(Texture::Cell& a, const Texture::Cell& b, float shift) noexcept {
  const auto expand = [](const float* p, float d, float* q) {
    q[0] = p[0] + d * (p[1] + d * (p[2] + d * p[3]));
    q[1] = p[1] + d * (2.0F * p[2] + 3.0F * d * p[3]);
    q[2] = p[2] + 3.0F * d * p[3];
    q[3] = p[3];
  };
  float before[4], after[4];
  expand(a.p, -shift, before);
  expand(b.p, shift, after);
  for (int i = 0; i < 4; ++i) a.p[i] = 0.5F * (before[i] + after[i]);
}

}  // namespace

std::size_t most_cells(int width) noexcept { return static_cast<std::size_t>(kCellsPerPixel * width + 16); }

void draw_texture_row(const Texture& texture, const TextureRow& row, int begin, int end, RenderLine& line,
                      float* light) noexcept {
  const CellRange range = cells_of(row, begin, end);
  texture.row(row.y_mm, range.first, range.count, line.cells.data());
  evaluate(row, range.first, line.cells.data(), begin, end, light);
}

void draw_background_row(const Texture& texture, const TextureRow& a, const TextureRow& b, int width,
                         RenderLine& line) noexcept {
  const TextureRow mean{0.0, 0.5 * (a.x0 + b.x0), 0.5 * (a.step + b.step)};
  const double shift0 = 0.5 * (b.x0 - a.x0), shift_step = 0.5 * (b.step - a.step);
  float* light = line.background.data();
  // If the motion within an exposure is a small part of a cell, both instants are merged into one polynomial per cell.
  // Beyond a cell's end this polynomial differs from its neighbour's by (shift^3) only. Otherwise both are drawn.
  if (std::max(std::abs(shift0), std::abs(shift0 + shift_step * width)) < kLargestMerge) {
    const CellRange range = cells_of(mean, 0, width);
    texture.row(a.y_mm, range.first, range.count, line.cells.data());
    texture.row(b.y_mm, range.first, range.count, line.other_cells.data());
    for (std::int64_t i = 0; i < range.count; ++i) {
      const double u = (static_cast<double>(range.first + i) + 0.5 - mean.x0) / mean.step;
      const auto k = static_cast<std::size_t>(i);
      mean_of_shifted(line.cells[k], line.other_cells[k], static_cast<float>(shift0 + shift_step * u));
    }
    evaluate(mean, range.first, line.cells.data(), 0, width, light);
    return;
  }
  draw_texture_row(texture, a, 0, width, line, light);
  draw_texture_row(texture, b, 0, width, line, line.plate.data());
  for (std::size_t u = 0; u < static_cast<std::size_t>(width); ++u) light[u] = 0.5F * (light[u] + line.plate[u]);
}

double covered(double centre, double low, double high) noexcept {
  return std::clamp(std::min(high, centre + 0.5) - std::max(low, centre - 0.5), 0.0, 1.0);
}

}  // namespace core::simulation
