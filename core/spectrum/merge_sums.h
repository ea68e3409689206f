#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// Sums of one record, and the properties that must agree before records may be added.
struct RecordSums {
  CpsdSums sums;
  std::vector<ChannelInfo> channels;
};

// Reason why two records may not be added, empty if they may: channels (names, in order), quantities, rate, segment,
// window and row delays must agree, the latter within `most_delay_apart_s`. Records that may not be added are
// identified separately and their modes combined (combine_estimates.h, merge_setups.h).
inline constexpr double kSameDelay_s = 1e-4;
[[nodiscard]] std::string why_not_addable(const RecordSums& a, const RecordSums& b,
                                          double most_delay_apart_s = kSameDelay_s);
// From another hover position a camera sees every channel slightly earlier or later. Up to a tenth of a sample this can
// be corrected in the sums.
[[nodiscard]] inline double most_delay_undone_s(double rate_hz) noexcept { return 0.1 / rate_hz; }

// Adds records as if each followed the previous one after a gap: the estimate depends on sums and counts only. Blocks
// stay in order and are joined to blocks of nearly equal size, whatever the records' lengths; this requires the total
// number of segments in advance. Row delays are converted to those of the first record: the cross-spectrum of channels
// i, j seen d_i, d_j later is multiplied by exp(-i w (d_i - d_j)). The same records in the same order give
// bit-identical results.
class SumOfRecords {
 public:
  SumOfRecords(std::uint64_t n_segments, std::size_t n_blocks) noexcept : n_expected_(n_segments), n_room_(n_blocks) {}

  // Throws std::invalid_argument with the result of why_not_addable(), for row delays within most_delay_undone_s().
  void add(const RecordSums& record);
  [[nodiscard]] const RecordSums& total() const noexcept { return total_; }

 private:
  void join(const CpsdSums& record);
  void take_blocks(const CpsdSums& record);
  void add_blocks(const CpsdSums& sums);

  std::uint64_t n_expected_, n_so_far_ = 0;  // segments
  std::size_t n_room_, place_ = 0;           // position of the last block, 0 .. n_room_ - 1
  bool is_empty_ = true, whole_ = true;      // whole_: the blocks add up to the sums
  RecordSums total_;
};

}  // namespace core
