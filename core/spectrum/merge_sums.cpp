#include "core/spectrum/merge_sums.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "core/spectrum/join_blocks.h"

namespace core {

namespace {

constexpr double kSame = 1e-12;  // relative

template <class... Args>
std::string text(const char* format, Args... args) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

bool same_delays(const std::vector<ChannelInfo>& a, const std::vector<ChannelInfo>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const ChannelInfo& p, const ChannelInfo& q) { return p.row_delay_s == q.row_delay_s; });
}

// Converts one bin of all pairs to earlier instants, by later_s per channel. turns[c] = exp(-i w later_s[c]).
void turn_bin(std::complex<double>* pairs, const std::vector<std::complex<double>>& turns) {
  for (std::size_t i = 0; i < turns.size(); ++i) {
    for (std::size_t j = i; j < turns.size(); ++j) *pairs++ *= turns[i] * std::conj(turns[j]);
  }
}

// Returns the sums as if every channel had been seen at the instants of `wanted`. Masks are unchanged: a shift of up to
// a tenth of a sample does not change which samples are missing.
CpsdSums with_delays_of(const RecordSums& record, const std::vector<ChannelInfo>& wanted) {
  CpsdSums sums = record.sums;
  std::vector<std::complex<double>> turns(wanted.size());
  for (int k = 0; k < sums.n_bins(); ++k) {
    const double w = 2.0 * std::numbers::pi * k * sums.rate_hz / sums.n_fft;
    for (std::size_t c = 0; c < wanted.size(); ++c)
      turns[c] = std::polar(1.0, -w * (record.channels[c].row_delay_s - wanted[c].row_delay_s));
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(k) * sums.n_pairs();
    turn_bin(sums.data_sum.data() + first, turns);
    for (std::size_t b = 0; b < sums.n_blocks; ++b) turn_bin(sums.blocks[b].data_sum.data() + first, turns);
  }
  return sums;
}

std::string channels_differ(const RecordSums& a, const RecordSums& b, double most_delay_apart_s) {
  if (a.channels.size() != b.channels.size()) {
    return text("%zu and %zu channels", a.channels.size(), b.channels.size());
  }
  for (std::size_t c = 0; c < a.channels.size(); ++c) {
    const ChannelInfo &own = a.channels[c], &other = b.channels[c];
    if (own.name != other.name) {
      return text("channel %zu is '%.60s' in one and '%.60s' in the other", c + 1, own.name.c_str(),
                  other.name.c_str());
    }
    if (own.n_integrations != other.n_integrations) {
      return text("channel '%.60s' holds different quantities", own.name.c_str());
    }
    const double apart_s = std::abs(own.row_delay_s - other.row_delay_s);
    if (!(apart_s <= most_delay_apart_s)) {
      return text("channel '%.60s' is seen %.3g ms later in one: another view or readout time", own.name.c_str(),
                  1e3 * apart_s);
    }
  }
  return "";
}

}  // namespace

std::string why_not_addable(const RecordSums& a, const RecordSums& b, double most_delay_apart_s) {
  const std::string channels = channels_differ(a, b, most_delay_apart_s);
  if (!channels.empty()) return channels;
  if (!(std::abs(a.sums.rate_hz - b.sums.rate_hz) <= kSame * a.sums.rate_hz)) {
    return text("%.6g and %.6g samples a second", a.sums.rate_hz, b.sums.rate_hz);
  }
  if (a.sums.n_channels != b.sums.n_channels || a.sums.n_fft != b.sums.n_fft ||
      a.sums.data_sum.size() != b.sums.data_sum.size()) {
    return "segments of different lengths";
  }
  if (!(std::abs(a.sums.window_power - b.sums.window_power) <= kSame * a.sums.window_power)) {
    return "different windows, or segments of different lengths";
  }
  return "";
}

void SumOfRecords::add(const RecordSums& record) {
  if (is_empty_) {
    total_.channels = record.channels;
    total_.sums = record.sums;
    total_.sums.blocks.clear();
    total_.sums.segments = {};  // phases of different records have nothing in common
    take_blocks(record.sums);
    is_empty_ = false;
    return;
  }
  const std::string reason = why_not_addable(total_, record, most_delay_undone_s(total_.sums.rate_hz));
  if (!reason.empty()) throw std::invalid_argument("records cannot be added: " + reason);
  if (same_delays(total_.channels, record.channels)) {
    join(record.sums);
  } else {
    join(with_delays_of(record, total_.channels));
  }
}

void SumOfRecords::join(const CpsdSums& record) {
  CpsdSums& sums = total_.sums;
  add_sums(sums.data_sum, record.data_sum);
  add_sums(sums.mask_sum, record.mask_sum);
  sums.n_segments += record.n_segments;
  sums.weight.join(record.weight);
  sums.n_samples += record.n_samples;
  sums.n_missing += record.n_missing;
  sums.n_outlying.resize(std::max(sums.n_outlying.size(), record.n_outlying.size()), 0);
  for (std::size_t c = 0; c < record.n_outlying.size(); ++c) sums.n_outlying[c] += record.n_outlying[c];
  take_blocks(record);
}

// If one record has no blocks, the blocks would not add up to the sums, and all are dropped.
void SumOfRecords::take_blocks(const CpsdSums& record) {
  whole_ = whole_ && (record.n_blocks > 0 || record.n_segments == 0);
  if (whole_) {
    add_blocks(record);
  } else {
    total_.sums.blocks.clear();
  }
  total_.sums.n_blocks = total_.sums.blocks.size();
}

// A block is added at the position of its middle in the whole record.
void SumOfRecords::add_blocks(const CpsdSums& sums) {
  for (std::size_t b = 0; b < sums.n_blocks; ++b) {
    const CpsdBlock& block = sums.blocks[b];
    const double middle = static_cast<double>(n_so_far_) + 0.5 * static_cast<double>(block.n_segments);
    const double share = middle / static_cast<double>(std::max<std::uint64_t>(n_expected_, 1));
    const auto place = static_cast<std::size_t>(share * static_cast<double>(n_room_));
    n_so_far_ += block.n_segments;
    if (total_.sums.blocks.empty() || (place > place_ && total_.sums.blocks.size() < n_room_)) {
      total_.sums.blocks.push_back(block);
      place_ = place;
    } else {
      join_blocks(total_.sums.blocks.back(), block);
    }
  }
}

}  // namespace core
