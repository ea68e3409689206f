#include "core/spectrum/welch_cpsd.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/linear/vector_clones.h"
#include "core/spectrum/bridge_losses.h"
#include "core/spectrum/gap_taper.h"

namespace core {
namespace {

using Complex = std::complex<double>;

void check(const WelchConfig& config) {
  if (config.n_channels <= std::max(0, config.n_witnesses)) throw std::invalid_argument("WelchCpsd: no channel");
  if (config.segment < 4)
    throw std::invalid_argument("WelchCpsd: segment of " + std::to_string(config.segment) + " samples; at least 4");
  if (!(config.overlap >= 0.0 && config.overlap < 1.0))
    throw std::invalid_argument("WelchCpsd: overlap must lie in 0 .. 1");
  if (config.n_blocks < 0 || config.n_blocks % 2 != 0)
    throw std::invalid_argument("WelchCpsd: number of blocks must be even and not negative");
  if (config.n_kept_segments < 0)
    throw std::invalid_argument("WelchCpsd: number of kept segments must not be negative");
  if (!(config.forget_s >= 0.0) || std::isinf(config.forget_s))
    throw std::invalid_argument("WelchCpsd: forget_s must be a time, or 0 for never");
  if (!(config.rate_hz > 0.0)) throw std::invalid_argument("WelchCpsd: rate must be positive");
}

int padded_length(const WelchConfig& config) {
  check(config);
  return next_power_of_two(2 * config.segment);
}

}  // namespace

namespace welch_kernels {

// Adds x_i conj(x_j), i <= j, to `sum`. by_real: re x, -im x; by_imaginary: im x, re x; channel by channel.
HOVERMODAL_VECTOR_CLONES
void add_outer_product(const double* __restrict by_real, const double* __restrict by_imaginary, int n_channels,
                       double* __restrict sum) {
  for (int i = 0; i < n_channels; ++i) {
    const double re = by_imaginary[2 * i + 1], im = by_imaginary[2 * i];
    const int n = 2 * (n_channels - i);
    for (int t = 0; t < n; ++t) sum[t] += re * by_real[2 * i + t] + im * by_imaginary[2 * i + t];
    sum += n;
  }
}

}  // namespace welch_kernels

CpsdSums WelchCpsd::empty_sums(const WelchConfig& config) {
  CpsdSums sums;
  sums.n_channels = config.n_channels;
  sums.n_fft = padded_length(config);
  sums.rate_hz = config.rate_hz;
  for (const double w : make_window(config.window, config.segment)) sums.window_power += w * w;
  const auto size = static_cast<std::size_t>(sums.n_bins()) * static_cast<std::size_t>(sums.n_pairs());
  sums.data_sum.assign(size, 0.0);
  sums.mask_sum.assign(size, 0.0);
  sums.n_outlying.assign(static_cast<std::size_t>(config.n_channels), 0);
  sums.blocks.resize(static_cast<std::size_t>(config.n_blocks));
  for (CpsdBlock& block : sums.blocks) {
    block.data_sum.assign(size, 0.0);
    block.mask_sum.assign(size, 0.0);
  }
  sums.segments =
      SegmentSpectra(static_cast<std::size_t>(config.n_kept_segments), static_cast<std::size_t>(config.n_channels),
                     static_cast<std::size_t>(sums.n_bins()), window_a0(config.window));
  return sums;
}

WelchCpsd::WelchCpsd(const WelchConfig& config)
    : config_(config),
      fft_(padded_length(config)),
      gate_(static_cast<std::size_t>(config.n_channels)),
      innovation_gate_(static_cast<std::size_t>(config.n_channels)),
      sums_(empty_sums(config)),
      aside_(static_cast<std::size_t>(config.n_channels), 0.0),
      is_aside_(static_cast<std::size_t>(config.n_channels), 0) {
  hop_ = std::max(1, config.segment - static_cast<int>(std::floor(config.segment * config.overlap)));
  window_ = make_window(config.window, config.segment);
  if (config.forget_s > 0.0) {
    const double hops = config.forget_s * config.rate_hz / hop_;  // within the time constant of forgetting
    kept_per_hop_ = std::exp(-1.0 / hops);
    const double per_block = std::clamp(2.0 * hops / std::max(1, config.n_blocks), 1.0, 1e15);
    most_segments_per_block_ = static_cast<std::uint64_t>(std::ceil(per_block));
  }
  const auto samples = static_cast<std::size_t>(config.n_channels) * static_cast<std::size_t>(config.segment);
  value_.assign(samples, 0.0);
  seen_.assign(samples, 0);
  if (config.bridge_losses) {
    bridged_.assign(samples, 0.0);
    held_.assign(samples, 0);
  }
  padded_.assign(static_cast<std::size_t>(fft_.size()), 0.0);
  const auto bins = static_cast<std::size_t>(config.n_channels) * static_cast<std::size_t>(fft_.n_bins());
  data_.assign(bins, 0.0);
  by_real_.assign(2 * static_cast<std::size_t>(config.n_channels), 0.0);
  by_imaginary_ = by_real_;
  mask_.assign(bins, 0.0);
  seen_share_.assign(static_cast<std::size_t>(config.n_channels), 0.0F);
}

void WelchCpsd::restart(double rate_hz) noexcept {
  sums_.rate_hz = rate_hz;
  sums_.n_segments = sums_.n_samples = sums_.n_missing = 0;
  sums_.weight = {};
  sums_.n_blocks = 0;
  sums_.segments.clear();
  std::fill(sums_.data_sum.begin(), sums_.data_sum.end(), Complex());
  std::fill(sums_.mask_sum.begin(), sums_.mask_sum.end(), Complex());
  for (CpsdBlock& block : sums_.blocks) block.n_segments = 0, block.weight = {};
  std::fill(sums_.n_outlying.begin(), sums_.n_outlying.end(), std::uint64_t{0});
  gate_.restart();
  innovation_gate_.restart();
  n_filled_ = n_new_ = 0;
  segments_per_block_ = 1;
  std::fill(value_.begin(), value_.end(), 0.0);
  std::fill(seen_.begin(), seen_.end(), std::uint8_t{0});
}

void WelchCpsd::put(std::size_t first, std::span<const double> value, std::span<const std::uint8_t> seen) noexcept {
  const auto segment = static_cast<std::size_t>(config_.segment);
  for (std::size_t c = 0; c < value.size(); ++c) {
    const bool valid = seen[c] != 0 && std::isfinite(value[c]);
    const std::size_t at = (first + c) * segment + static_cast<std::size_t>(n_filled_);
    value_[at] = valid ? value[c] : 0.0;
    seen_[at] = valid ? 1 : 0;
    if (!valid && first + c < n_counted()) ++sums_.n_missing;
    gate(first + c, value[c], valid);
  }
}

bool WelchCpsd::push(std::span<const double> value, std::span<const std::uint8_t> seen) noexcept {
  assert(value.size() == static_cast<std::size_t>(config_.n_channels) && seen.size() == value.size());
  put(0, value, seen);
  return advance();
}

bool WelchCpsd::push(const DisplacementSample& sample) noexcept {
  assert(sample.value_mm.size() + sample.witness_mm.size() == static_cast<std::size_t>(config_.n_channels));
  put(0, sample.value_mm, sample.seen);
  put(sample.value_mm.size(), sample.witness_mm, sample.witness_seen);
  return advance();
}

bool WelchCpsd::push_missing() noexcept {
  const auto segment = static_cast<std::size_t>(config_.segment);
  for (std::size_t c = 0; c < static_cast<std::size_t>(config_.n_channels); ++c) {
    const std::size_t at = c * segment + static_cast<std::size_t>(n_filled_);
    value_[at] = 0.0, seen_[at] = 0;
    gate(c, 0.0, false);
  }
  sums_.n_missing += n_counted();
  return advance();
}

bool WelchCpsd::advance() noexcept {
  gate_by_prediction();
  ++sums_.n_samples;
  ++n_filled_, ++n_new_;
  if (n_filled_ < config_.segment) return false;
  set_doubtful_aside();
  accumulate_segment();
  restore_doubtful();
  const auto segment = static_cast<std::ptrdiff_t>(config_.segment);
  for (std::ptrdiff_t c = 0; c < config_.n_channels; ++c) {
    std::copy(value_.begin() + c * segment + hop_, value_.begin() + (c + 1) * segment, value_.begin() + c * segment);
    std::copy(seen_.begin() + c * segment + hop_, seen_.begin() + (c + 1) * segment, seen_.begin() + c * segment);
  }
  n_filled_ -= hop_;
  return true;
}

// Nothing will confirm the last sample.
void WelchCpsd::flush() noexcept {
  for (std::size_t c = 0; c < is_aside_.size(); ++c) gate(c, 0.0, false);
  if (n_new_ == 0) return;
  const auto segment = static_cast<std::ptrdiff_t>(config_.segment);
  for (std::ptrdiff_t c = 0; c < config_.n_channels; ++c) {
    std::fill(value_.begin() + c * segment + n_filled_, value_.begin() + (c + 1) * segment, 0.0);
    std::fill(seen_.begin() + c * segment + n_filled_, seen_.begin() + (c + 1) * segment, std::uint8_t{0});
  }
  // A window of the remainder's own length: slow motion that ends at an edge of the longer one spreads over all
  // frequencies.
  fill_window(config_.window, std::span(window_).first(static_cast<std::size_t>(n_filled_)));
  accumulate_segment();
  fill_window(config_.window, window_);
}

void WelchCpsd::accumulate_segment() noexcept {
  const auto segment = static_cast<std::ptrdiff_t>(config_.segment);
  bool one_mask = true;
  for (std::ptrdiff_t c = 1; c < config_.n_channels && one_mask; ++c) {
    one_mask = std::equal(seen_.begin(), seen_.begin() + segment, seen_.begin() + c * segment);
  }
  for (int c = 0; c < config_.n_channels; ++c) {
    transform_channel(c);
    if (c == 0 || !one_mask) transform_mask(c);
  }
  fade();
  add_products(one_mask, sums_.data_sum, sums_.mask_sum);
  sums_.weight.add_one();
  if (!sums_.blocks.empty()) {
    CpsdBlock& block = current_block();
    ++block.n_segments;
    block.weight.add_one();
    add_products(one_mask, block.data_sum, block.mask_sum);
  }
  keep_spectra(one_mask);
  ++sums_.n_segments;
  n_new_ = 0;
}

void WelchCpsd::keep_spectra(bool one_mask) noexcept {
  if (sums_.segments.n_room() == 0) return;
  const auto bins = static_cast<std::size_t>(fft_.n_bins());
  double whole = 0.0;
  for (int t = 0; t < n_filled_; ++t) whole += window_[static_cast<std::size_t>(t)];
  for (std::size_t c = 0; c < seen_share_.size(); ++c)
    seen_share_[c] = whole > 0.0 ? static_cast<float>(mask_[one_mask ? 0 : c * bins].real() / whole) : 0.0F;
  const auto n = static_cast<std::uint64_t>(n_filled_);
  sums_.segments.add({sums_.n_samples - n, n, 1.0}, seen_share_, data_);
}

void WelchCpsd::transform_channel(int channel) noexcept {
  const auto segment = static_cast<std::size_t>(config_.segment);
  const auto bins = static_cast<std::size_t>(fft_.n_bins());
  const auto c = static_cast<std::size_t>(channel);
  std::span<const double> value(value_.data() + c * segment, segment);
  std::span<const std::uint8_t> seen(seen_.data() + c * segment, segment);
  if (config_.bridge_losses) {
    const std::span<double> bridged(bridged_.data() + c * segment, segment);
    const std::span<std::uint8_t> held(held_.data() + c * segment, segment);
    bridge_losses(value, seen, bridged, held);
    value = bridged;
    seen = held;
  }
  // n_fft is at least two segments, so the upper half is free. The end of a partial last segment is no gap.
  const auto n = static_cast<std::size_t>(n_filled_);
  window_about_mean(value.first(n), seen.first(n), std::span(window_).first(n), {padded_.data() + segment, n},
                    {padded_.data(), n});
  std::fill(padded_.begin() + n_filled_, padded_.end(), 0.0);
  fft_.forward(padded_, {data_.data() + c * bins, bins});
}

void WelchCpsd::transform_mask(int channel) noexcept {
  const auto segment = static_cast<std::size_t>(config_.segment);
  const auto bins = static_cast<std::size_t>(fft_.n_bins());
  const auto c = static_cast<std::size_t>(channel);
  const std::uint8_t* seen = (config_.bridge_losses ? held_ : seen_).data() + c * segment;  // after transform_channel()
  const auto n = static_cast<std::size_t>(n_filled_);
  (void)gap_weights({seen, n}, {padded_.data(), n});
  std::fill(padded_.begin() + n_filled_, padded_.end(), 0.0);
  for (std::size_t t = 0; t < n; ++t) padded_[t] *= window_[t];
  fft_.forward(padded_, {mask_.data() + c * bins, bins});
}

void WelchCpsd::add_products(bool one_mask, std::vector<Complex>& data_sum, std::vector<Complex>& mask_sum) noexcept {
  const auto channels = static_cast<std::size_t>(config_.n_channels);
  const auto bins = static_cast<std::size_t>(fft_.n_bins());
  const auto pairs = static_cast<std::size_t>(sums_.n_pairs());
  const auto add = [&](const std::vector<Complex>& spectra, std::vector<Complex>& sums, std::size_t k) noexcept {
    for (std::size_t c = 0; c < channels; ++c) {
      const Complex x = spectra[c * bins + k];
      by_real_[2 * c] = x.real();
      by_real_[2 * c + 1] = -x.imag();
      by_imaginary_[2 * c] = x.imag();
      by_imaginary_[2 * c + 1] = x.real();
    }
    // std::complex<double> has the layout of two doubles ([complex.numbers.general]).
    welch_kernels::add_outer_product(by_real_.data(), by_imaginary_.data(), config_.n_channels,
                                     reinterpret_cast<double*>(sums.data() + k * pairs));
  };
  for (std::size_t k = 0; k < bins; ++k) {
    add(data_, data_sum, k);
    if (!one_mask) {
      add(mask_, mask_sum, k);
      continue;
    }
    const double power = mask_[k].real() * mask_[k].real() + mask_[k].imag() * mask_[k].imag();
    Complex* mask = mask_sum.data() + k * pairs;
    for (std::size_t pair = 0; pair < pairs; ++pair) mask[pair] += power;
  }
}

}  // namespace core
