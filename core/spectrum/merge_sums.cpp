#include "core/spectrum/merge_sums.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "core/spectrum/join_blocks.h"

namespace core {

namespace {

constexpr double kMostDelayApart_s = 1e-4;
constexpr double kSame = 1e-12;  // relative

template <class... Args>
std::string text(const char* format, Args... args) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

std::string channels_differ(const RecordSums& a, const RecordSums& b) {
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
    if (!(apart_s <= kMostDelayApart_s)) {
      return text("channel '%.60s' is seen %.3g ms later in one: another view or readout time", own.name.c_str(),
                  1e3 * apart_s);
    }
  }
  return "";
}

}  // namespace

std::string why_not_addable(const RecordSums& a, const RecordSums& b) {
  const std::string channels = channels_differ(a, b);
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
  CpsdSums& sums = total_.sums;
  if (is_empty_) {
    total_ = record;
    sums.blocks.clear(), sums.n_blocks = 0;
    is_empty_ = false;
  } else {
    const std::string reason = why_not_addable(total_, record);
    if (!reason.empty()) throw std::invalid_argument("records cannot be added: " + reason);
    add_sums(sums.data_sum, record.sums.data_sum);
    add_sums(sums.mask_sum, record.sums.mask_sum);
    sums.n_segments += record.sums.n_segments;
    sums.weight.join(record.sums.weight);
    sums.n_samples += record.sums.n_samples;
    sums.n_missing += record.sums.n_missing;
  }
  // Where one record has none, the parts would not be the whole: then there are none.
  whole_ = whole_ && (record.sums.n_blocks > 0 || record.sums.n_segments == 0);
  if (whole_) {
    add_blocks(record.sums);
  } else {
    sums.blocks.clear();
  }
  sums.n_blocks = sums.blocks.size();
}

// A block goes where its middle lies in the whole.
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
