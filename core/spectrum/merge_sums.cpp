#include "core/spectrum/merge_sums.h"

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

std::vector<CpsdBlock> blocks_in_use(const CpsdSums& sums) {
  return {sums.blocks.begin(), sums.blocks.begin() + static_cast<std::ptrdiff_t>(sums.n_blocks)};
}

void join_pairs(std::vector<CpsdBlock>& blocks) {
  std::vector<CpsdBlock> joined;
  for (std::size_t b = 0; b < blocks.size(); b += 2) {
    joined.push_back(std::move(blocks[b]));
    if (b + 1 < blocks.size()) join_blocks(joined.back(), blocks[b + 1]);
  }
  blocks = std::move(joined);
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

void add_record(RecordSums& into, const RecordSums& from) {
  const std::string reason = why_not_addable(into, from);
  if (!reason.empty()) throw std::invalid_argument("records cannot be added: " + reason);
  CpsdSums& sums = into.sums;
  std::vector<CpsdBlock> blocks = blocks_in_use(sums);
  for (CpsdBlock& block : blocks_in_use(from.sums)) blocks.push_back(std::move(block));
  add_sums(sums.data_sum, from.sums.data_sum);
  add_sums(sums.mask_sum, from.sums.mask_sum);
  sums.n_segments += from.sums.n_segments;
  sums.weight.join(from.sums.weight);
  sums.n_samples += from.sums.n_samples;
  sums.n_missing += from.sums.n_missing;
  // Without room for blocks on one side the parts would not be the whole: then there are none.
  const bool whole = !sums.blocks.empty() && (from.sums.n_blocks > 0 || from.sums.n_segments == 0);
  while (whole && blocks.size() > sums.blocks.size()) join_pairs(blocks);
  sums.n_blocks = whole ? blocks.size() : 0;
  for (std::size_t b = 0; b < sums.n_blocks; ++b) sums.blocks[b] = std::move(blocks[b]);
}

}  // namespace core
