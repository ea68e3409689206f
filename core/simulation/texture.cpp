#include "core/simulation/texture.h"

#include <array>
#include <cmath>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

// Mean square of the unit-coefficient spline along one axis: integral of the squared cubic B-spline.
constexpr double kMeanSquare = 151.0 / 315.0;

std::array<double, 4> weights(double s) noexcept {
  const double r = 1.0 - s;
  return {r * r * r / 6.0, (4.0 + s * s * (3.0 * s - 6.0)) / 6.0, (4.0 + r * r * (3.0 * r - 6.0)) / 6.0,
          s * s * s / 6.0};
}

}  // namespace

Texture::Texture(const TextureParameters& texture, int cells, std::uint64_t seed, std::string_view name,
                 std::uint64_t index)
    : pitch_mm_(texture.pitch_mm), n_(cells), mean_(texture.mean) {
  RandomStream stream(seed, name, index);
  coefficient_.resize(static_cast<std::size_t>(n_ * n_));
  for (float& c : coefficient_) c = static_cast<float>(texture.contrast_rms / kMeanSquare * stream.gaussian());
}

const float* Texture::coefficients(std::int64_t row) const noexcept {
  return coefficient_.data() + (row & (n_ - 1)) * n_;
}

double Texture::value(double x_mm, double y_mm) const noexcept {
  const double x = x_mm / pitch_mm_, y = y_mm / pitch_mm_;
  const double cell_x = std::floor(x), cell_y = std::floor(y);
  const auto wx = weights(x - cell_x), wy = weights(y - cell_y);
  const auto first = static_cast<std::int64_t>(cell_x) - 1;
  double sum = mean_;
  for (std::int64_t j = 0; j < 4; ++j) {
    const float* row = coefficients(static_cast<std::int64_t>(cell_y) - 1 + j);
    double line = 0.0;
    for (std::int64_t i = 0; i < 4; ++i) {
      line += wx[static_cast<std::size_t>(i)] * static_cast<double>(row[(first + i) & (n_ - 1)]);
    }
    sum += wy[static_cast<std::size_t>(j)] * line;
  }
  return sum;
}

void Texture::row(double y_mm, std::int64_t first, std::int64_t count, Cell* cells) const noexcept {
  const double y = y_mm / pitch_mm_;
  const double cell_y = std::floor(y);
  const auto w = weights(y - cell_y);
  const float w0 = static_cast<float>(w[0]), w1 = static_cast<float>(w[1]);
  const float w2 = static_cast<float>(w[2]), w3 = static_cast<float>(w[3]);
  const auto top = static_cast<std::int64_t>(cell_y) - 1;
  const float *r0 = coefficients(top), *r1 = coefficients(top + 1);
  const float *r2 = coefficients(top + 2), *r3 = coefficients(top + 3);
  const auto column = [&](std::int64_t i) {
    const std::int64_t k = i & (n_ - 1);
    return w0 * r0[k] + w1 * r1[k] + w2 * r2[k] + w3 * r3[k];
  };
  const float mean = static_cast<float>(mean_);
  float a = column(first - 1), b = column(first), c = column(first + 1);
  for (std::int64_t i = 0; i < count; ++i) {
    const float d = column(first + i + 2);
    cells[i].p[0] = mean + (a + 4.0F * b + c) / 6.0F;
    cells[i].p[1] = (c - a) / 2.0F;
    cells[i].p[2] = (a - 2.0F * b + c) / 2.0F;
    cells[i].p[3] = (d - a + 3.0F * (b - c)) / 6.0F;
    a = b;
    b = c;
    c = d;
  }
}

}  // namespace core::simulation
