#include "core/identification/participation.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <string>

namespace core {

namespace {

// Smallest share of the record of the most observed channel.
constexpr double kLeastShare = 0.3;
// Above this share a channel may lack one contiguous stretch: its spectra miss little of the modes' energy.
constexpr double kLeastUnevenShare = 0.9;
// Standard deviation of the observed share over the blocks of the record, relative to its mean; random losses give a
// few per cent.
constexpr double kMostUnevenness = 0.2;

template <class... Args>
std::string text(const char* format, Args... args) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

// Window power of the observed samples: the mask's own correlation at lag 0 (Parseval).
double seen_power(const std::vector<std::complex<double>>& mask_sum, const CpsdSums& sums, int channel) {
  const auto pairs = static_cast<std::size_t>(sums.n_pairs());
  const auto pair = static_cast<std::size_t>(CpsdSums::pair_index(channel, channel, sums.n_channels));
  const auto bins = static_cast<std::size_t>(sums.n_bins());
  double power = mask_sum[pair].real() + mask_sum[(bins - 1) * pairs + pair].real();
  for (std::size_t k = 1; k + 1 < bins; ++k) power += 2.0 * mask_sum[k * pairs + pair].real();
  return power / sums.n_fft;
}

struct Share {
  double mean = 0.0, unevenness = 0.0;
};

// Share of a channel in the record of `best`, and its variation over the record. Without blocks only the mean is known.
Share share_of(const CpsdSums& sums, int channel, int best, double least_power) {
  Share out;
  const double whole = seen_power(sums.mask_sum, sums, best);
  out.mean = whole > 0.0 ? seen_power(sums.mask_sum, sums, channel) / whole : 0.0;
  double weight = 0.0, sum = 0.0, squares = 0.0;
  for (std::size_t b = 0; b < sums.n_blocks; ++b) {
    const double block = seen_power(sums.blocks[b].mask_sum, sums, best);
    if (!(block > least_power)) continue;
    const double share = seen_power(sums.blocks[b].mask_sum, sums, channel) / block;
    weight += block, sum += block * share, squares += block * share * share;
  }
  if (!(weight > 0.0)) return out;
  const double mean = sum / weight;
  out.mean = std::min(out.mean, mean);  // samples observed while `best` was missing do not count
  if (mean > 0.0) out.unevenness = std::sqrt(std::max(0.0, squares / weight - mean * mean)) / mean;
  return out;
}

std::string reason_to_leave_out(const Share& share) {
  if (!(share.mean > 1e-6)) return "it has no sample";
  if (share.mean < kLeastShare)
    return text("it was seen in %.2g %% of the record: too few joint samples with the others", 100.0 * share.mean);
  if (share.mean < kLeastUnevenShare && share.unevenness > kMostUnevenness)
    return text(
        "it was seen in %.0f %% of the record only, in one stretch: its spectra are not those of the others' record",
        100.0 * share.mean);
  return {};
}

}  // namespace

Participation participation(const CpsdSums& sums, const std::vector<ChannelInfo>& channels) {
  Participation out;
  out.records.resize(channels.size());
  if (sums.n_segments == 0 || sums.mask_sum.empty() || channels.size() != static_cast<std::size_t>(sums.n_channels)) {
    for (std::size_t c = 0; c < channels.size(); ++c) out.kept.push_back(c);
    return out;
  }
  int best = 0;
  double most = -1.0;
  for (int c = 0; c < sums.n_channels; ++c) {
    const double power = channels[static_cast<std::size_t>(c)].is_witness ? 0.0 : seen_power(sums.mask_sum, sums, c);
    if (power > most) most = power, best = c;
  }
  const double least_power = 1e-3 * sums.window_power;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Share share = share_of(sums, static_cast<int>(c), best, least_power);
    ChannelRecord& record = out.records[c];
    record.seen = std::min(1.0, share.mean);
    record.n_outlying = c < sums.n_outlying.size() ? sums.n_outlying[c] : 0;
    record.reason = reason_to_leave_out(share);
    record.takes_part = record.reason.empty();
    if (record.takes_part) out.kept.push_back(c);
  }
  return out;
}

int lone_masked_channel(const std::vector<std::complex<double>>& shape, const std::vector<ChannelRecord>& records) {
  constexpr std::size_t kLeastChannels = 3;
  if (shape.size() < kLeastChannels || records.size() < shape.size()) return -1;
  double whole = 0.0;
  for (const auto& z : shape) whole += std::norm(z);
  for (std::size_t c = 0; c < shape.size(); ++c) {
    if (records[c].seen < kWholeRecord && std::norm(shape[c]) > kAlone * whole) return static_cast<int>(c);
  }
  return -1;
}

}  // namespace core
