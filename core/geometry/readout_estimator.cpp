#include "core/geometry/readout_estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/geometry/readout_bands.h"
#include "core/spectrum/kaiser_window.h"
#include "core/types/constants.h"

namespace core {

namespace {

constexpr double kSegment_s = 8.0;  // slow drift is informative: a segment contains a few of its periods
constexpr double kTop = 0.42;       // of the rate: highest bin, where the differentiator is still accurate
constexpr double kKaiserBeta = 8.0;

int segment_length(double rate_hz) {
  if (!(rate_hz > 0.0) || !std::isfinite(rate_hz))
    throw std::invalid_argument("ReadoutEstimator: rate " + std::to_string(rate_hz) + " Hz; it must be positive");
  const double wanted = std::clamp(kSegment_s * rate_hz, 64.0, 1024.0);
  return 1 << static_cast<int>(std::lround(std::log2(wanted)));
}

}  // namespace

ReadoutEstimator::ReadoutEstimator(const Config& config, const TrackFrame& keyframe)
    : shear_(config.shear, keyframe),
      n_channels_(RegionShear::kAxes * config.shear.n_regions),
      rate_hz_(config.rate_hz),
      grid_(config.rate_hz),
      last_seen_(config.shear.n_regions, -1),
      frame_(shear_.sample_prototype()),
      segment_(segment_length(config.rate_hz)),
      fft_(segment_) {
  ring_.fill(frame_);
  double slope = 0.0;
  for (int k = 1; k <= kHalf; ++k) {
    const double edge = static_cast<double>(k) / (kHalf + 1);
    taps_[static_cast<std::size_t>(k)] = (k % 2 == 0 ? -1.0 : 1.0) / k * kaiser_window(edge, kKaiserBeta);
    slope += 2.0 * k * taps_[static_cast<std::size_t>(k)];
  }
  for (double& tap : taps_) tap /= slope;  // exact for a straight line
  const auto n = static_cast<std::size_t>(segment_);
  for (std::size_t t = 0; t < n; ++t)
    window_.push_back(0.5 - 0.5 * std::cos(2.0 * kPi * (static_cast<double>(t) + 0.5) / segment_));
  window_sum_.assign(n_channels_, 0.0);
  velocity_.assign(n_channels_ * n, 0.0);
  shear_px_.assign(n_channels_ * n, 0.0);
  seen_.assign(config.shear.n_regions * n, 0);
  work_.assign(n, 0.0);
  const auto n_bins = static_cast<std::size_t>(fft_.n_bins());
  velocity_bins_.assign(n_channels_ * n_bins, {});
  shear_bins_.assign(n_channels_ * n_bins, {});
  instrument_.assign(n_channels_, {});
  for (std::size_t bin = 0; bin < n_bins; ++bin) {
    double gain = 0.0;
    for (int k = 1; k <= kHalf; ++k) {
      gain += 2.0 * taps_[static_cast<std::size_t>(k)] * std::sin(2.0 * kPi * static_cast<double>(bin) * k / segment_);
    }
    const double omega = 2.0 * kPi * static_cast<double>(bin) / segment_;
    velocity_gain_.push_back(bin == 0 || !(gain > 0.0) ? 1.0 : omega / gain);
    noise_gain_.push_back(omega * omega);
  }
  // Bands are half an octave wide, at least one bin; bin 0 is excluded, because it contains the keyframe's errors.
  const auto last = static_cast<std::size_t>(kTop * segment_);
  double edge = 1.0;
  first_bin_[0] = 1;
  while (n_bands_ < kMaxBands && first_bin_[n_bands_] <= last) {
    edge = std::max(edge * std::numbers::sqrt2, edge + 1.0);
    first_bin_[n_bands_ + 1] = std::min(last + 1, static_cast<std::size_t>(std::lround(edge)));
    ++n_bands_;
  }
  estimate_ = combined();
}

void ReadoutEstimator::update(const TrackFrame& tracks) noexcept {
  const TimeGrid::Placement placement = grid_.place(tracks.t_start_ns);
  if (!placement.accepted) return;
  if (placement.n_missing_before > kRing) {
    clear_ring();
  } else {
    for (std::uint64_t k = 0; k < placement.n_missing_before; ++k) push_cell(false);
  }
  shear_.fit(tracks, frame_);
  push_cell(true);
}

// The segment keeps its content: the discontinuity affects one sample, equally in both series.
void ReadoutEstimator::clear_ring() noexcept {
  n_cells_ = 0;
  std::fill(last_seen_.begin(), last_seen_.end(), -1);
}

void ReadoutEstimator::push_cell(bool seen) noexcept {
  RegionShear::Sample& cell = at(n_cells_);
  if (seen) {
    std::swap(cell, frame_);
    for (std::size_t r = 0; r < last_seen_.size(); ++r) {
      if (cell.seen[r] == 0) continue;
      bridge(r);
      last_seen_[r] = n_cells_;
    }
  } else {
    std::fill(cell.seen.begin(), cell.seen.end(), std::uint8_t{0});
  }
  ++n_cells_;
  if (n_cells_ >= kRing) differentiate();
}

// Interpolates linearly over the cells in which the region was lost, in both series.
void ReadoutEstimator::bridge(std::size_t region) noexcept {
  const std::int64_t from = last_seen_[region], gap = n_cells_ - from;
  if (from < 0 || gap < 2 || gap > kMostBridged + 1) return;
  const RegionShear::Sample &start = at(from), &end = at(n_cells_);
  for (std::int64_t k = 1; k < gap; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(gap);
    RegionShear::Sample& cell = at(from + k);
    for (std::size_t c = RegionShear::kAxes * region; c < RegionShear::kAxes * (region + 1); ++c) {
      cell.carrier_px[c] = std::lerp(start.carrier_px[c], end.carrier_px[c], share);
      cell.shear_px[c] = std::lerp(start.shear_px[c], end.shear_px[c], share);
    }
    cell.seen[region] = 1;
  }
}

// Computes the velocity of the cell at the filter's centre and adds it to the segment.
void ReadoutEstimator::differentiate() noexcept {
  const std::int64_t middle = n_cells_ - 1 - kMostBridged - kHalf;
  const auto n = static_cast<std::size_t>(segment_), t = static_cast<std::size_t>(filled_);
  for (std::size_t r = 0; r < last_seen_.size(); ++r) {
    bool whole = true;
    for (int k = -kHalf; k <= kHalf && whole; ++k) whole = at(middle + k).seen[r] != 0;
    seen_[r * n + t] = whole ? 1 : 0;
    for (std::size_t c = RegionShear::kAxes * r; c < RegionShear::kAxes * (r + 1); ++c) {
      double velocity = 0.0;
      for (int k = 1; k <= kHalf && whole; ++k) {
        velocity += taps_[static_cast<std::size_t>(k)] * (at(middle + k).carrier_px[c] - at(middle - k).carrier_px[c]);
      }
      velocity_[c * n + t] = velocity;
      shear_px_[c * n + t] = whole ? at(middle).shear_px[c] : 0.0;
    }
  }
  if (++filled_ == segment_) take_segment();
}

void ReadoutEstimator::take_segment() noexcept {
  transform_channels();
  add_bins();
  close_segment();
  estimate_ = combined();
  const auto n = static_cast<std::size_t>(segment_), half = n / 2;
  const auto shift = [&](auto& series, std::size_t rows) {
    for (std::size_t r = 0; r < rows; ++r) {
      const auto row = series.begin() + static_cast<std::ptrdiff_t>(r * n);
      std::copy(row + static_cast<std::ptrdiff_t>(half), row + static_cast<std::ptrdiff_t>(n), row);
    }
  };
  shift(velocity_, n_channels_);
  shift(shear_px_, n_channels_);
  shift(seen_, last_seen_.size());
  filled_ = segment_ / 2;
}

void ReadoutEstimator::transform_channels() noexcept {
  const auto n = static_cast<std::size_t>(segment_), n_bins = static_cast<std::size_t>(fft_.n_bins());
  const auto transform = [&](const double* series, const std::uint8_t* seen, std::complex<double>* bins) {
    double sum = 0.0, count = 0.0;
    for (std::size_t t = 0; t < n; ++t) {
      if (seen[t] == 0) continue;
      sum += series[t];
      count += 1.0;
    }
    const double mean = count > 0.0 ? sum / count : 0.0;
    for (std::size_t t = 0; t < n; ++t) work_[t] = seen[t] != 0 ? (series[t] - mean) * window_[t] : 0.0;
    fft_.forward(work_, {bins, n_bins});
  };
  for (std::size_t c = 0; c < n_channels_; ++c) {
    const std::uint8_t* seen = seen_.data() + c / RegionShear::kAxes * n;
    transform(velocity_.data() + c * n, seen, velocity_bins_.data() + c * n_bins);
    transform(shear_px_.data() + c * n, seen, shear_bins_.data() + c * n_bins);
    window_sum_[c] = 0.0;
    for (std::size_t t = 0; t < n; ++t) window_sum_[c] += seen[t] != 0 ? window_[t] * window_[t] : 0.0;
  }
}

void ReadoutEstimator::add_bins() noexcept {
  Block& block = blocks_[n_blocks_ == 0 ? 0 : n_blocks_ - 1];
  const auto n_bins = static_cast<std::size_t>(fft_.n_bins());
  const auto& m = shear_.information();
  double noise = 0.0, values = 0.0;
  for (std::size_t c = 0; c < n_channels_; ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    if (m(i, i) > 0.0) values += window_sum_[c];
    for (std::size_t d = 0; d < n_channels_; ++d) {
      const auto j = static_cast<Eigen::Index>(d);
      noise += m(i, j) * shear_.carrier_covariance()(j, i) * std::sqrt(window_sum_[c] * window_sum_[d]);
    }
  }
  for (std::size_t b = 0; b < n_bands_; ++b) {
    Sums& sums = block[b];
    for (std::size_t bin = first_bin_[b]; bin < first_bin_[b + 1]; ++bin) {
      const double gain = velocity_gain_[bin];
      make_instruments(bin);
      for (std::size_t i = 0; i < n_channels_; ++i) {
        std::complex<double> mv, ms, mz;
        for (std::size_t j = 0; j < n_channels_; ++j) {
          const double weight = m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
          mv += gain * weight * velocity_bins_[j * n_bins + bin];
          ms += weight * shear_bins_[j * n_bins + bin];
          mz += gain * weight * instrument_[j];
        }
        const std::complex<double> v = gain * velocity_bins_[i * n_bins + bin], s = shear_bins_[i * n_bins + bin];
        const std::complex<double> z = gain * instrument_[i];
        sums.velocity += v.real() * mv.real() + v.imag() * mv.imag();
        sums.cross += v.real() * ms.real() + v.imag() * ms.imag();
        sums.shear += s.real() * ms.real() + s.imag() * ms.imag();
        sums.on_velocity += z.real() * mv.real() + z.imag() * mv.imag();
        sums.on_cross += z.real() * ms.real() + z.imag() * ms.imag();
        sums.on += z.real() * mz.real() + z.imag() * mz.imag();
      }
      sums.velocity_noise += noise_gain_[bin] * noise;
      sums.n_values += values;
    }
  }
}

// Mean velocity of the other regions along the same axis; 0 without any.
void ReadoutEstimator::make_instruments(std::size_t bin) noexcept {
  const auto n_bins = static_cast<std::size_t>(fft_.n_bins());
  const auto is_seen = [&](std::size_t c) { return window_sum_[c] > 0.0; };
  for (std::size_t axis = 0; axis < RegionShear::kAxes; ++axis) {
    std::complex<double> sum;
    double n = 0.0;
    for (std::size_t c = axis; c < n_channels_; c += RegionShear::kAxes) {
      if (!is_seen(c)) continue;
      sum += velocity_bins_[c * n_bins + bin];
      n += 1.0;
    }
    for (std::size_t c = axis; c < n_channels_; c += RegionShear::kAxes) {
      instrument_[c] = is_seen(c) && n > 1.0 ? (sum - velocity_bins_[c * n_bins + bin]) / (n - 1.0) : 0.0;
    }
  }
}

void ReadoutEstimator::close_segment() noexcept {
  if (n_blocks_ == 0) n_blocks_ = 1;
  ++n_segments_;
  if (++segments_in_last_ < segments_per_block_) return;
  if (n_blocks_ == kMaxBlocks) {
    for (std::size_t k = 0; k < kMaxBlocks / 2; ++k) {
      for (std::size_t b = 0; b < n_bands_; ++b) {
        Sums both = blocks_[2 * k][b];
        both.add(blocks_[2 * k + 1][b]);
        blocks_[k][b] = both;
      }
    }
    n_blocks_ = kMaxBlocks / 2;
    segments_per_block_ *= 2;
  }
  blocks_[n_blocks_++] = {};
  segments_in_last_ = 0;
}

ReadoutEstimate ReadoutEstimator::combined() const noexcept {
  const std::size_t n = segments_in_last_ == 0 && n_blocks_ > 0 ? n_blocks_ - 1 : n_blocks_;
  ReadoutEstimate estimate = combine_bands({blocks_.data(), n}, n_bands_, 0.375 * segment_);
  estimate.seconds_used =
      n_segments_ == 0 ? 0.0
                       : 0.5 * static_cast<double>((n_segments_ + 1) * static_cast<std::size_t>(segment_)) / rate_hz_;
  return estimate;
}

}  // namespace core
