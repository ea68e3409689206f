#include "core/tracking/klt/interpolated_window.h"

#include <algorithm>
#include <cmath>

#include "core/linear/vector_clones.h"

namespace core {

namespace {

constexpr double kWeightUnit = 32768.0;
constexpr double kParameters = 4.0;  // shift, gain and offset
constexpr double kLeastFreedom = 0.3;

using Weights = std::array<std::int16_t, kSplineTaps>;

// Rounded product with a weight of 15 fractional bits, in the form that compilers recognise as one instruction.
inline std::int16_t weighed(std::int16_t value, std::int16_t weight) {
  return static_cast<std::int16_t>((((static_cast<std::int32_t>(value) * weight) >> 14) + 1) >> 1);
}

HOVERMODAL_VECTOR_CLONES
void widen(const std::uint8_t* __restrict pixels, std::size_t stride, std::int16_t* __restrict out) {
  for (int y = 0; y < kImageRows; ++y, pixels += stride, out += kImageColumns)
    for (int x = 0; x < kImageColumns; ++x) out[x] = static_cast<std::int16_t>(pixels[x] << kGreyBits);
}

// Combines six rows of the image, then six columns.
HOVERMODAL_VECTOR_CLONES
void interpolate(const std::int16_t* __restrict rows, const std::int16_t* __restrict across,
                 const std::int16_t* __restrict down, std::int16_t* __restrict out) {
  const std::int16_t a0 = across[0], a1 = across[1], a2 = across[2], a3 = across[3], a4 = across[4], a5 = across[5];
  const std::int16_t d0 = down[0], d1 = down[1], d2 = down[2], d3 = down[3], d4 = down[4], d5 = down[5];
  alignas(64) std::int16_t joined[kImageColumns];
  for (int y = 0; y < kFolded; ++y, rows += kImageColumns, out += kRow) {
    for (int x = 0; x < kImageColumns; ++x)
      joined[x] = static_cast<std::int16_t>(
          weighed(rows[x], d0) + weighed(rows[x + kImageColumns], d1) + weighed(rows[x + 2 * kImageColumns], d2) +
          weighed(rows[x + 3 * kImageColumns], d3) + weighed(rows[x + 4 * kImageColumns], d4) +
          weighed(rows[x + 5 * kImageColumns], d5));
    for (int x = 0; x < kRow; ++x)
      out[x] = static_cast<std::int16_t>(weighed(joined[x], a0) + weighed(joined[x + 1], a1) +
                                         weighed(joined[x + 2], a2) + weighed(joined[x + 3], a3) +
                                         weighed(joined[x + 4], a4) + weighed(joined[x + 5], a5));
  }
}

// Sums with the factors of both axes. They fit in 32 bits: point_template.cpp limits the factors.
HOVERMODAL_VECTOR_CLONES
void add_products(const std::int16_t* __restrict window, const std::int16_t* __restrict step_u,
                  const std::int16_t* __restrict step_v, std::int32_t* __restrict out) {
  std::int32_t u = 0, v = 0;
  for (int i = 0; i < kFolded * kRow; ++i) {
    u += window[i] * step_u[i];
    v += window[i] * step_v[i];
  }
  out[0] = u;
  out[1] = v;
}

// Grey values in 8ths about `level` (in 128ths) where mask is -1: the squares of a whole window fit in 32 bits.
HOVERMODAL_VECTOR_CLONES
void add_moments(const std::int16_t* __restrict window, const std::int16_t* __restrict texture,
                 const std::int16_t* __restrict mask, std::int16_t level, int n, std::int32_t* __restrict out) {
  std::int32_t image = 0, image2 = 0, both = 0;
  for (int i = 0; i < n; ++i) {
    const auto value = static_cast<std::int16_t>(((window[i] - level) >> (kGreyBits - kMatchBits)) & mask[i]);
    image += value;
    image2 += value * value;
    both += value * texture[i];
  }
  out[0] = image;
  out[1] = image2;
  out[2] = both;
}

// Rounded so that their sum is exact: a constant image is unchanged.
Weights integer_weights(double fraction) {
  const auto weights = spline_weights(fraction);
  Weights out{};
  int rest = static_cast<int>(kWeightUnit);
  for (std::size_t k = 0; k < kSplineTaps; ++k) {
    out[k] = static_cast<std::int16_t>(kWeightUnit * weights[k] + 0.5);
    rest -= out[k];
  }
  std::int16_t& middle = out[fraction < 0.5 ? kSplineBefore : kSplineBefore + 1];
  middle = static_cast<std::int16_t>(middle + rest);
  return out;
}

double sum_of_squares(const Weights& weights) {
  double sum = 0.0;
  for (const std::int16_t w : weights) sum += static_cast<double>(w) * w;
  return sum / (kWeightUnit * kWeightUnit);
}

}  // namespace

void InterpolatedWindow::begin(const GrayView& gray, const PointTemplate& point) noexcept {
  gray_ = gray;
  point_ = &point;
  is_loaded_ = false;
}

void InterpolatedWindow::load(int cell_u, int cell_v) noexcept {
  if (is_loaded_ && cell_u == cell_u_ && cell_v == cell_v_) return;
  cell_u_ = cell_u, cell_v_ = cell_v;
  is_loaded_ = true;
  const int first_u = cell_u - kFoldedRadius - kSplineBefore, first_v = cell_v - kFoldedRadius - kSplineBefore;
  if (first_u >= 0 && first_v >= 0 && first_u + kImageColumns <= gray_.width && first_v + kImageRows <= gray_.height) {
    widen(gray_.row(first_v) + first_u, gray_.stride, pixels_.data());
    return;
  }
  for (int y = 0; y < kImageRows; ++y) {
    const std::uint8_t* row = gray_.row(mirrored(first_v + y, gray_.height));
    for (int x = 0; x < kImageColumns; ++x)
      pixels_[static_cast<std::size_t>(y * kImageColumns + x)] =
          static_cast<std::int16_t>(row[mirrored(first_u + x, gray_.width)] << kGreyBits);
  }
}

void InterpolatedWindow::move_to(int cell_u, int cell_v, double fraction_u, double fraction_v) noexcept {
  load(cell_u, cell_v);
  const Weights across = integer_weights(fraction_u), down = integer_weights(fraction_v);
  interpolate(pixels_.data(), across.data(), down.data(), window_.data());
  passed_noise_ = sum_of_squares(across) * sum_of_squares(down);
}

Vector2 InterpolatedWindow::step() const noexcept {
  std::int32_t sums[2];
  add_products(window_.data(), point_->step_u.data(), point_->step_v.data(), sums);
  constexpr double kGreyUnit = 1.0 / (1 << kGreyBits);
  return {point_->px_per_unit * (kGreyUnit * sums[0] - point_->origin_u),
          point_->px_per_unit * (kGreyUnit * sums[1] - point_->origin_v)};
}

TemplateMatch InterpolatedWindow::match(const Vector2& rest) const noexcept {
  const int r = point_->radius;
  const std::size_t first = std::size_t{kRow} * static_cast<std::size_t>(kFoldedRadius - r);
  std::int32_t sums[3];
  add_moments(window_.data() + first, point_->texture.data() + first, point_->mask.data() + first,
              static_cast<std::int16_t>(std::lround(point_->mean * (1 << kGreyBits))), (2 * r + 1) * kRow, sums);
  constexpr double kUnit = 1.0 / (1 << kMatchBits);
  const double n = (2.0 * r + 1.0) * (2.0 * r + 1.0);
  const double image = kUnit * sums[0] / n;
  const double image2 = kUnit * kUnit * sums[1] / n - image * image;
  const double both = kUnit * kUnit * sums[2] / n - image * point_->texture_mean;
  TemplateMatch match;
  if (!(image2 > 0.0) || !(point_->texture_variance > 0.0)) return match;
  match.gain = both / point_->texture_variance;
  // The fitted parameters are low-pass: they absorb noise that the interpolation passes unattenuated.
  const double freedom = std::max(kLeastFreedom * n, n - kParameters / passed_noise_);
  // Uses the gradients of the image as attenuated by the spline.
  const double explained = (rest.u * rest.u / point_->variance_u + rest.v * rest.v / point_->variance_v) *
                           point_->texture_variance / point_->variance;
  match.residual_unit = 1.0 / (freedom * passed_noise_);
  match.residual = std::max(0.0, (image2 - match.gain * both) * n - explained) * match.residual_unit;
  match.correlation = both / std::sqrt(image2 * point_->texture_variance);
  return match;
}

}  // namespace core
