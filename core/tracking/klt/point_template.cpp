#include "core/tracking/klt/point_template.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace core {

namespace {

constexpr std::array<double, 2 * kPrefilterMargin + 1> kPrefilter = spline_prefilter<>();

// exp(-k^2 / (2 0.7^2)), k = 0 ... 3: smoothing across the gradient; multiplied by k, the derivative along it.
constexpr std::array<double, 4> kGauss{1.0, 0.36044778859782, 0.01687989150494, 0.00010269492446};
constexpr double kGaussSum = kGauss[0] + 2.0 * (kGauss[1] + kGauss[2] + kGauss[3]);
constexpr double kSlopeSum = 2.0 * (kGauss[1] + 4.0 * kGauss[2] + 9.0 * kGauss[3]);

// Sums over the folded window of grey values in 128ths fit in 32 bits, and each factor in 16.
constexpr double kMostFactor = 32'000.0;
constexpr double kMostSum = 2.1e9 / (255.0 * 128.0);

// Weights of the coefficients at a sample: spline_weights(0).
constexpr std::array<double, 5> kAtSample{1.0 / 120.0, 26.0 / 120.0, 66.0 / 120.0, 26.0 / 120.0, 1.0 / 120.0};

// Largest share of a patch's variance that counts as noise: the rest of what resembles noise is fine texture.
constexpr double kMostNoiseShare = 0.5;

// Smallest eigenvalue of the normal matrix (grey^2 per pixel): below, a patch has texture in one direction only.
constexpr double kLeastEigenvalue = 0.05;

using Window = std::array<std::array<double, kWindow>, kWindow>;
using Folded = std::array<std::array<double, kFolded>, kFolded>;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

// out(y, x): sums over taps -radius ... radius of two filters, for a region about the patch's centre.
template <std::size_t kAcross, std::size_t kDown, class Out>
void filter(const Patch& patch, const std::array<double, kAcross>& across, const std::array<double, kDown>& down,
            int radius, Out& out) noexcept {
  constexpr int kA = static_cast<int>(kAcross) / 2, kD = static_cast<int>(kDown) / 2;
  std::array<std::array<double, kPatch>, kPatch> rows{};
  for (int y = -radius - kD; y <= radius + kD; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      double sum = 0.0;
      for (int k = -kA; k <= kA; ++k)
        sum += across[index(k + kA)] * patch[index(y + kPatchRadius)][index(x + k + kPatchRadius)];
      rows[index(y + kPatchRadius)][index(x + radius)] = sum;
    }
  }
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      double sum = 0.0;
      for (int k = -kD; k <= kD; ++k) sum += down[index(k + kD)] * rows[index(y + k + kPatchRadius)][index(x + radius)];
      out[index(y + radius)][index(x + radius)] = sum;
    }
  }
}

constexpr std::array<double, 7> gaussian() {
  std::array<double, 7> taps{};
  for (int k = -3; k <= 3; ++k)
    taps[static_cast<std::size_t>(k + 3)] = kGauss[static_cast<std::size_t>(k < 0 ? -k : k)] / kGaussSum;
  return taps;
}
constexpr std::array<double, 7> gaussian_slope() {
  std::array<double, 7> taps{};
  for (int k = -3; k <= 3; ++k)
    taps[static_cast<std::size_t>(k + 3)] = k * kGauss[static_cast<std::size_t>(k < 0 ? -k : k)] / kSlopeSum;
  return taps;
}
// Filter from samples to the spline's slope at a sample.
constexpr std::array<double, 15> spline_slope() { return joined(kPrefilter, kSplineSlope); }

// Sum of the products of both gradients' taps: contribution of white noise to H per pixel.
constexpr double noise_in_both() {
  constexpr auto kSmooth = gaussian_slope();
  constexpr auto kExact = spline_slope();
  double sum = 0.0;
  for (std::size_t k = 0; k < kSmooth.size(); ++k) sum += kSmooth[k] * kExact[k + 4];
  return sum / kGaussSum;
}
constexpr double kNoiseInBoth = noise_in_both();
constexpr double kLeastWithoutNoise =
    0.6;  // apparent noise may be fine texture: a step overshoots by less than a factor of two

template <class Function>
void for_window(int radius, const Function& function) {
  for (int y = kWindowRadius - radius; y <= kWindowRadius + radius; ++y)
    for (int x = kWindowRadius - radius; x <= kWindowRadius + radius; ++x) function(index(y), index(x));
}
double area(int radius) { return static_cast<double>((2 * radius + 1) * (2 * radius + 1)); }

// Removes from `step` the components along the template (about its mean) and a constant.
void make_orthogonal(Window& step, int radius, const Window& texture, double texture_square) {
  double mean = 0.0, along = 0.0;
  for_window(radius, [&](std::size_t y, std::size_t x) { mean += step[y][x], along += step[y][x] * texture[y][x]; });
  mean /= area(radius);
  for_window(radius,
             [&](std::size_t y, std::size_t x) { step[y][x] -= mean + along / texture_square * texture[y][x]; });
}

// Combines the window's factors with the prefilter.
void fold(const Window& step, Folded& out) {
  std::array<std::array<double, kFolded>, kWindow> rows{};
  for (int y = 0; y < kWindow; ++y)
    for (int x = 0; x < kWindow; ++x)
      for (std::size_t k = 0; k < kPrefilter.size(); ++k)
        rows[index(y)][index(x) + k] += step[index(y)][index(x)] * kPrefilter[k];
  out = {};
  for (int y = 0; y < kWindow; ++y)
    for (std::size_t k = 0; k < kPrefilter.size(); ++k)
      for (std::size_t x = 0; x < kFolded; ++x) out[index(y) + k][x] += kPrefilter[k] * rows[index(y)][x];
}

double largest(const Folded& a) {
  double most = 0.0;
  for (const auto& row : a)
    for (const double value : row) most = std::max(most, std::abs(value));
  return most;
}

double sum_of_sizes(const Folded& a) {
  double sum = 0.0;
  for (const auto& row : a)
    for (const double value : row) sum += std::abs(value);
  return sum;
}

void round_to(const Folded& factors, double scale, PointTemplate::Factors& out) {
  out.fill(0);
  for (int y = 0; y < kFolded; ++y)
    for (int x = 0; x < kFolded; ++x)
      out[index(y * kRow + x)] = static_cast<std::int16_t>(std::lround(scale * factors[index(y)][index(x)]));
}

// The rounded sums at the template itself; subtracting them avoids an offset by rounding. samples: the patch
// interpolated at its pixels.
double sum_at_origin(const Folded& samples, const PointTemplate::Factors& step) {
  double sum = 0.0;
  for (int y = 0; y < kFolded; ++y)
    for (int x = 0; x < kFolded; ++x) sum += step[index(y * kRow + x)] * samples[index(y)][index(x)];
  return sum;
}

// Stores the template as an interpolated window would contain it.
void keep_texture(const Folded& samples, PointTemplate& out) {
  out.texture.fill(0);
  out.mask.fill(0);
  double sum = 0.0, square = 0.0;
  constexpr double kUnit = 1 << kMatchBits;
  for (int y = kFoldedRadius - out.radius; y <= kFoldedRadius + out.radius; ++y) {
    for (int x = kFoldedRadius - out.radius; x <= kFoldedRadius + out.radius; ++x) {
      const auto value = static_cast<std::int16_t>(std::lround(kUnit * (samples[index(y)][index(x)] - out.mean)));
      out.texture[index(y * kRow + x)] = value;
      out.mask[index(y * kRow + x)] = -1;
      sum += value / kUnit, square += value / kUnit * (value / kUnit);
    }
  }
  out.texture_mean = sum / area(out.radius);
  out.texture_variance = square / area(out.radius) - out.texture_mean * out.texture_mean;
}

// g x^T: decrease of a window's grey values per unit of each element of A.
std::array<double, 4> change_by_deformation(const Window& slope_u, const Window& slope_v, std::size_t y,
                                            std::size_t x) noexcept {
  const double u = static_cast<double>(x) - kWindowRadius, v = static_cast<double>(y) - kWindowRadius;
  return {slope_u[y][x] * u, slope_u[y][x] * v, slope_v[y][x] * u, slope_v[y][x] * v};
}

// Energy of this change not explained by offset, gain or shift, in interpolated windows (smoothed by the spline).
void keep_deformation_energy(const Patch& patch, PointTemplate& out) noexcept {
  Window texture{}, slope_u{}, slope_v{};
  filter(patch, kAtSample, kAtSample, kWindowRadius, texture);
  filter(patch, kSplineSlope, kAtSample, kWindowRadius, slope_u);
  filter(patch, kAtSample, kSplineSlope, kWindowRadius, slope_v);
  std::array<std::array<double, 8>, 8> gram{};
  for_window(out.radius, [&](std::size_t y, std::size_t x) {
    const auto change = change_by_deformation(slope_u, slope_v, y, x);
    const std::array<double, 8> row{
        1.0, texture[y][x] - out.mean, slope_u[y][x], slope_v[y][x], change[0], change[1], change[2], change[3]};
    for (std::size_t k = 0; k < row.size(); ++k)
      for (std::size_t l = k; l < row.size(); ++l) gram[k][l] += row[k] * row[l];
  });
  for (std::size_t pivot = 0; pivot < 4; ++pivot) {  // eliminates offset, gain, shift
    if (!(gram[pivot][pivot] > 0.0)) continue;
    for (std::size_t k = pivot + 1; k < gram.size(); ++k)
      for (std::size_t l = k; l < gram.size(); ++l) gram[k][l] -= gram[pivot][k] * gram[pivot][l] / gram[pivot][pivot];
  }
  for (std::size_t k = 0, at = 0; k < 4; ++k)
    for (std::size_t l = k; l < 4; ++l) out.deformed.energy[at++] = (k == l ? 1.0 : 2.0) * gram[4 + k][4 + l];
}

// From differences that cancel for a plane and nearly cancel for smooth texture (Immerkaer 1996).
double noise_variance(const Patch& patch, int radius) {
  double sum = 0.0;
  for (int y = kPatchRadius - radius; y <= kPatchRadius + radius; ++y) {
    for (int x = kPatchRadius - radius; x <= kPatchRadius + radius; ++x) {
      const auto at = [&](int dy, int dx) { return patch[index(y + dy)][index(x + dx)]; };
      const double difference = at(-1, -1) + at(-1, 1) + at(1, -1) + at(1, 1) -
                                2.0 * (at(-1, 0) + at(1, 0) + at(0, -1) + at(0, 1)) + 4.0 * at(0, 0);
      sum += difference * difference;
    }
  }
  return sum / (36.0 * area(radius));
}

// Computes the factors that convert an image's difference from the template to a step, pixel by pixel, and the grey
// values and variances of `out`. False: no texture in two directions.
bool linearise(const Patch& patch, int radius, PointTemplate& out, Window& step_u, Window& step_v) noexcept {
  constexpr std::array<double, 1> kSame{1.0};
  Window texture{}, smooth_u{}, smooth_v{}, slope_u{}, slope_v{};
  filter(patch, kSame, kSame, kWindowRadius, texture);
  filter(patch, gaussian_slope(), gaussian(), kWindowRadius, smooth_u);
  filter(patch, gaussian(), gaussian_slope(), kWindowRadius, smooth_v);
  filter(patch, spline_slope(), kSame, kWindowRadius, slope_u);
  filter(patch, kSame, spline_slope(), kWindowRadius, slope_v);

  double mean = 0.0, square = 0.0;
  for_window(radius, [&](std::size_t y, std::size_t x) { mean += texture[y][x]; });
  mean /= area(radius);
  for_window(radius,
             [&](std::size_t y, std::size_t x) { texture[y][x] -= mean, square += texture[y][x] * texture[y][x]; });
  out.mean = mean;
  out.variance = square / area(radius);
  if (out.n_averaged == 1) out.noise = std::min(noise_variance(patch, radius), kMostNoiseShare * out.variance);
  if (!(square > 0.0)) return false;
  make_orthogonal(smooth_u, radius, texture, square);
  make_orthogonal(smooth_v, radius, texture, square);

  double uu = 0.0, uv = 0.0, vu = 0.0, vv = 0.0;
  for_window(radius, [&](std::size_t y, std::size_t x) {
    uu += smooth_u[y][x] * slope_u[y][x], uv += smooth_u[y][x] * slope_v[y][x];
    vu += smooth_v[y][x] * slope_u[y][x], vv += smooth_v[y][x] * slope_v[y][x];
  });
  // The template's noise increases both gradients; without this correction steps would be too short.
  const double own = area(radius) * kNoiseInBoth * out.noise / out.n_averaged;
  uu = std::max(kLeastWithoutNoise * uu, uu - own), vv = std::max(kLeastWithoutNoise * vv, vv - own);
  const double determinant = uu * vv - uv * vu;
  const double trace = uu + vv;
  const double least = 0.5 * (trace - std::sqrt(std::max(0.0, trace * trace - 4.0 * determinant)));
  if (!(least > kLeastEigenvalue * area(radius))) return false;

  double var_u = 0.0, var_v = 0.0;
  for_window(radius, [&](std::size_t y, std::size_t x) {
    step_u[y][x] = (vv * smooth_u[y][x] - uv * smooth_v[y][x]) / determinant;
    step_v[y][x] = (uu * smooth_v[y][x] - vu * smooth_u[y][x]) / determinant;
    var_u += step_u[y][x] * step_u[y][x], var_v += step_v[y][x] * step_v[y][x];
  });
  out.variance_u = var_u, out.variance_v = var_v;
  out.deformed.pull = {};
  for_window(radius, [&](std::size_t y, std::size_t x) {
    const std::array<double, 4> change = change_by_deformation(slope_u, slope_v, y, x);
    for (std::size_t k = 0; k < change.size(); ++k) {
      Vector2& pull = out.deformed.pull[k];
      pull = {pull.u + step_u[y][x] * change[k], pull.v + step_v[y][x] * change[k]};
    }
  });
  return true;
}

}  // namespace

bool has_texture(const Patch& patch, int radius) noexcept {
  PointTemplate described;
  Window step_u{}, step_v{};
  return linearise(patch, radius, described, step_u, step_v);
}

void build_template(const Patch& patch, int radius, int n_averaged, PointTemplate& out) noexcept {
  out.n_averaged = n_averaged;
  out.radius = radius;
  Window step_u{}, step_v{};
  out.is_trackable = linearise(patch, radius, out, step_u, step_v);
  if (!out.is_trackable) return;

  Folded folded_u, folded_v;
  fold(step_u, folded_u);
  fold(step_v, folded_v);
  const double scale = std::min(kMostFactor / std::max(largest(folded_u), largest(folded_v)),
                                kMostSum / std::max(sum_of_sizes(folded_u), sum_of_sizes(folded_v)));
  round_to(folded_u, scale, out.step_u);
  round_to(folded_v, scale, out.step_v);
  out.px_per_unit = 1.0 / scale;
  Folded samples;
  filter(patch, kAtSample, kAtSample, kFoldedRadius, samples);
  out.origin_u = sum_at_origin(samples, out.step_u);
  out.origin_v = sum_at_origin(samples, out.step_v);

  keep_texture(samples, out);
  keep_deformation_energy(patch, out);
}

}  // namespace core
