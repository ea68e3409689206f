#include "core/simulation/render/texture.h"

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
                 std::uint64_t index, const TexturePattern& pattern)
    : pitch_mm_(texture.pitch_mm), n_(cells), stride_(cells + 3), mean_(texture.mean) {
  RandomStream stream(seed, name, index);
  coefficient_.resize(static_cast<std::size_t>(n_ * stride_));
  for (std::int64_t j = 0; j < n_; ++j) {
    float* row = coefficient_.data() + j * stride_;
    for (std::int64_t i = 0; i < n_; ++i) {
      row[i] = static_cast<float>(texture.contrast_rms / kMeanSquare * stream.gaussian());
    }
    for (std::int64_t i = 0; pattern && i < n_; ++i) {
      // The half of the period beyond its middle lies before the origin.
      const auto place_mm = [&](std::int64_t k) { return pitch_mm_ * static_cast<double>(k < n_ / 2 ? k : k - n_); };
      const PatternPoint shown = pattern(place_mm(i), place_mm(j));
      row[i] = static_cast<float>(shown.grey + shown.noise * static_cast<double>(row[i]));
    }
    for (std::int64_t i = 0; i < stride_ - n_; ++i) row[n_ + i] = row[i];
  }
}

const float* Texture::coefficients(std::int64_t row) const noexcept {
  return coefficient_.data() + (row & (n_ - 1)) * stride_;
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

namespace {

constexpr int kLook = Texture::kLook;

// Points split into the cell's index and the four weights at its fraction, which lie apart so that the compiler takes
// several points at a time.
struct Split {
  std::int32_t cell[kLook];
  float w[4][kLook];

  explicit Split(const double* __restrict at) noexcept {
    constexpr double kBias = 1 << 24;  // a multiple of every texture's period; truncation is then rounding down
    for (int i = 0; i < kLook; ++i) {
      const double biased = at[i] + kBias;
      cell[i] = static_cast<std::int32_t>(biased);
      const auto s = static_cast<float>(biased - static_cast<double>(cell[i]));
      const float r = 1.0F - s;
      w[0][i] = r * r * r * (1.0F / 6.0F);
      w[1][i] = (4.0F + s * s * (3.0F * s - 6.0F)) * (1.0F / 6.0F);
      w[2][i] = (4.0F + r * r * (3.0F * r - 6.0F)) * (1.0F / 6.0F);
      w[3][i] = s * s * s * (1.0F / 6.0F);
    }
  }
};

}  // namespace

void Texture::look(const double* x, const double* y, float* value) const noexcept {
  const Split along(x), down(y);
  const std::int64_t mask = n_ - 1;
  float column[kLook][4];
  for (int i = 0; i < kLook; ++i) {
    const float* first = coefficient_.data() + ((along.cell[i] - 1) & mask);
    const std::int64_t top = down.cell[i] - 1;
    const float *r0 = first + (top & mask) * stride_, *r1 = first + ((top + 1) & mask) * stride_;
    const float *r2 = first + ((top + 2) & mask) * stride_, *r3 = first + ((top + 3) & mask) * stride_;
    for (int k = 0; k < 4; ++k) {
      column[i][k] = down.w[0][i] * r0[k] + down.w[1][i] * r1[k] + down.w[2][i] * r2[k] + down.w[3][i] * r3[k];
    }
  }
  const auto mean = static_cast<float>(mean_);
  for (int i = 0; i < kLook; ++i) {
    value[i] = mean + (along.w[0][i] * column[i][0] + along.w[1][i] * column[i][1] + along.w[2][i] * column[i][2] +
                       along.w[3][i] * column[i][3]);
  }
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
