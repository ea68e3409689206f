#include "core/simulation/render/render_line.h"

#include <algorithm>

namespace core::simulation {

RenderLine::RenderLine(int length, std::size_t n_cells) {
  const auto padded = static_cast<std::size_t>(length + Texture::kLook);
  for (std::vector<float>* values : {&light, &background, &plate, &cover, &open[0], &open[1]}) values->resize(padded);
  for (std::vector<double>* values : {&ray_x[0], &ray_x[1], &ray_y[0], &ray_y[1]}) values->resize(padded);
  cells.resize(n_cells);
  other_cells.resize(n_cells);
  pixels.resize(padded);
}

void RenderLine::begin() noexcept {
  for (std::vector<float>& share : open) std::fill(share.begin(), share.end(), 1.0F);
}

void lay_plate(RenderLine& line, int begin, int end, std::size_t instant, float weight) noexcept {
  float* open = line.open[instant].data();
  for (int u = begin; u < end; ++u) {
    const auto i = static_cast<std::size_t>(u);
    line.light[i] += weight * line.cover[i] * open[u] * (line.plate[i] - line.background[i]);
    open[u] *= 1.0F - line.cover[i];
  }
}

}  // namespace core::simulation
