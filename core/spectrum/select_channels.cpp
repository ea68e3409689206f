#include "core/spectrum/select_channels.h"

#include <complex>

namespace core {

namespace {

using Complex = std::complex<double>;

// Indices of the pairs kept, in the order of the smaller sums.
std::vector<std::size_t> kept_pairs(int n_channels, const std::vector<std::size_t>& keep) {
  std::vector<std::size_t> pairs;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    for (std::size_t j = i; j < keep.size(); ++j)
      pairs.push_back(static_cast<std::size_t>(
          CpsdSums::pair_index(static_cast<int>(keep[i]), static_cast<int>(keep[j]), n_channels)));
  }
  return pairs;
}

std::vector<Complex> selected(const std::vector<Complex>& from, std::size_t per_bin,
                              const std::vector<std::size_t>& pairs) {
  std::vector<Complex> out;
  out.reserve(from.size() / per_bin * pairs.size());
  for (std::size_t first = 0; first + per_bin <= from.size(); first += per_bin) {
    for (const std::size_t pair : pairs) out.push_back(from[first + pair]);
  }
  return out;
}

}  // namespace

CpsdSums select_channels(const CpsdSums& sums, const std::vector<std::size_t>& keep) {
  const auto per_bin = static_cast<std::size_t>(sums.n_pairs());
  const std::vector<std::size_t> pairs = kept_pairs(sums.n_channels, keep);
  CpsdSums out;
  out.n_channels = static_cast<int>(keep.size());
  out.n_fft = sums.n_fft, out.rate_hz = sums.rate_hz;
  out.n_segments = sums.n_segments, out.weight = sums.weight;
  out.n_samples = sums.n_samples, out.n_missing = sums.n_missing;
  out.window_power = sums.window_power;
  for (const std::size_t c : keep) {
    if (c < sums.n_outlying.size()) out.n_outlying.push_back(sums.n_outlying[c]);
  }
  out.data_sum = selected(sums.data_sum, per_bin, pairs);
  out.mask_sum = selected(sums.mask_sum, per_bin, pairs);
  for (std::size_t b = 0; b < sums.n_blocks; ++b) {
    const CpsdBlock& block = sums.blocks[b];
    out.blocks.push_back({block.n_segments, block.weight, selected(block.data_sum, per_bin, pairs),
                          selected(block.mask_sum, per_bin, pairs)});
  }
  out.n_blocks = out.blocks.size();
  if (sums.segments.n_room() > 0) out.segments = sums.segments.of_channels(keep);
  return out;
}

}  // namespace core
