#include "core/geometry/readout_bands.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {

using Sums = ReadoutEstimator::Sums;
using Bands = std::array<Sums, ReadoutEstimator::kMaxBands>;
constexpr double kOverlap = 1.2;        // variance factor: segments with 50 % overlap share part of their noise
constexpr double kLeastVelocity = 3.0;  // ratio of velocity to its noise, below which a band is not informative
constexpr double kAgree_sigmas = 4.0;
constexpr double kAgree_frames = 0.03;  // tolerance in addition to the standard deviations, for model errors
constexpr double kObservable_frames = 0.25;
constexpr int kRounds = 8;

struct Band {
  double velocity = 0.0, cross = 0.0;  // A and B
  double noise = 0.0;                  // s_b^2
  double scale = 0.0;                  // of the instrument; 0: V itself
  double frames = 0.0, variance = 0.0;
  bool tells = false, agrees = false;
};

double velocity_of(const Band& band, const Sums& sums) noexcept {
  return band.scale != 0.0 ? band.scale * sums.on_velocity : sums.velocity - band.noise * sums.velocity_noise;
}

double cross_of(const Band& band, const Sums& sums) noexcept {
  return band.scale != 0.0 ? band.scale * sums.on_cross : sums.cross;
}

// Computes s_b^2 at a given readout, and A and B.
void settle(Band& band, const Sums& sums, double frames) noexcept {
  const double residual = sums.shear - 2.0 * frames * sums.cross + frames * frames * sums.velocity;
  const double values = sums.n_values + frames * frames * sums.velocity_noise;
  band.noise = values > 0.0 ? std::max(residual / values, 1e-12) : 0.0;
  band.velocity = velocity_of(band, sums);
  band.cross = cross_of(band, sums);
}

Band read_band(const Sums& sums, double window_energy) noexcept {
  Band band;
  if (!(sums.velocity > 0.0) || !(sums.n_values > 0.0) || !std::isfinite(sums.velocity + sums.cross + sums.shear))
    return band;
  const bool instrumented = sums.on > 0.0 && sums.on_velocity != 0.0;
  if (instrumented) band.scale = sums.on_velocity / sums.on;
  settle(band, sums, instrumented ? sums.on_cross / sums.on_velocity : sums.cross / sums.velocity);
  band.tells = band.velocity > kLeastVelocity * band.noise * sums.velocity_noise;
  if (!band.tells) return band;
  band.frames = band.cross / band.velocity;
  band.variance = 0.5 * kOverlap * window_energy * band.noise / band.velocity;
  return band;
}

bool agree(const Band& a, const Band& b) noexcept {
  const double apart = std::abs(a.frames - b.frames) - kAgree_frames;
  return apart <= kAgree_sigmas * std::sqrt(a.variance + b.variance);
}

using BandList = std::array<Band, ReadoutEstimator::kMaxBands>;

// Marks the largest set of bands that agree with one of them. Its size is the sum of log(1 + (0.1 / deviation)^2), so
// that a single strong line does not outweigh many other bands; of equal sets the lowest, where motion is not aliased.
void mark_agreement(BandList& bands) noexcept {
  double best = -1.0;
  std::size_t anchor = 0;
  for (std::size_t a = 0; a < bands.size(); ++a) {
    if (!bands[a].tells) continue;
    double score = 0.0;
    for (const Band& band : bands) {
      if (band.tells && agree(bands[a], band)) score += std::log1p(0.01 / band.variance);
    }
    if (score > best) {
      best = score;
      anchor = a;
    }
  }
  for (Band& band : bands) band.agrees = band.tells && agree(bands[anchor], band);
}

double weighted_mean(const BandList& bands) noexcept {
  double velocity = 0.0, cross = 0.0;
  for (const Band& band : bands) {
    if (!band.agrees) continue;
    velocity += band.velocity / band.noise;
    cross += band.cross / band.noise;
  }
  return velocity > 0.0 ? cross / velocity : 0.0;
}

struct Deviation {
  double variance = 0.0;
  int n_degrees = 0;
};

// The largest of: sigma from noise alone; scatter of the blocks; noise scaled up by the disagreement of the bands.
Deviation deviation(const BandList& bands, double frames, std::span<const Bands> blocks,
                    double window_energy) noexcept {
  double weight = 0.0, chi2 = 0.0, squares = 0.0;
  int n_bands = 0;
  for (const Band& band : bands) {
    if (!band.agrees) continue;
    weight += band.velocity / band.noise;
    chi2 += (band.frames - frames) * (band.frames - frames) / band.variance;
    ++n_bands;
  }
  for (const Bands& block : blocks) {
    double excess = 0.0;
    for (std::size_t b = 0; b < bands.size(); ++b) {
      if (!bands[b].agrees) continue;
      excess += (cross_of(bands[b], block[b]) - frames * velocity_of(bands[b], block[b])) / bands[b].noise;
    }
    squares += excess * excess;
  }
  const auto n = static_cast<int>(blocks.size());
  const double noise = 0.5 * kOverlap * window_energy / weight;
  const double widened = n_bands > 1 ? noise * chi2 / (n_bands - 1) : noise;
  const double scatter = n > 1 ? squares * n / (n - 1) / (weight * weight) : 0.0;
  return {std::max({noise, widened, scatter}), std::max(1, n - 1)};
}

}  // namespace

void ReadoutEstimator::Sums::add(const Sums& more) noexcept {
  velocity += more.velocity;
  cross += more.cross;
  shear += more.shear;
  on_velocity += more.on_velocity;
  on_cross += more.on_cross;
  on += more.on;
  velocity_noise += more.velocity_noise;
  n_values += more.n_values;
}

ReadoutEstimate combine_bands(std::span<const Bands> blocks, std::size_t n_bands, double window_energy) noexcept {
  Bands total{};
  for (const Bands& block : blocks) {
    for (std::size_t b = 0; b < n_bands; ++b) total[b].add(block[b]);
  }
  BandList bands{};
  for (std::size_t b = 0; b < n_bands; ++b) bands[b] = read_band(total[b], window_energy);
  mark_agreement(bands);
  double frames = weighted_mean(bands);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t b = 0; b < n_bands; ++b) {
      if (bands[b].agrees) settle(bands[b], total[b], frames);
    }
    frames = weighted_mean(bands);
  }
  ReadoutEstimate estimate;
  for (const Band& band : bands) {
    estimate.n_bands += band.tells ? 1 : 0;
    estimate.n_bands_against += band.tells && !band.agrees ? 1 : 0;
  }
  if (estimate.n_bands == 0) return estimate;
  const Deviation spread = deviation(bands, frames, blocks, window_energy);
  const double std_frames = std::sqrt(spread.variance);
  estimate.observable = std::isfinite(frames) && std_frames < kObservable_frames;
  if (!estimate.observable) return estimate;
  estimate.frames = frames;
  estimate.std_frames = std_frames;
  estimate.n_degrees = spread.n_degrees;
  return estimate;
}

}  // namespace core
