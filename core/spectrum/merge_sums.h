#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// One record's sums with what its channels are: what has to agree before records may be added.
struct RecordSums {
  CpsdSums sums;
  std::vector<ChannelInfo> channels;
};

// Why two records may not be added, empty when they may: channels (names, in order), quantities, rate, segment, window
// and row delays (within 0.1 ms) must agree. Others are identified each and their modes combined
// (combine_estimates.h, merge_setups.h).
[[nodiscard]] std::string why_not_addable(const RecordSums& a, const RecordSums& b);

// Records as one, as if each had followed the one before it after a gap: all of the estimate is sums and counts. Their
// blocks stand in order, joined to blocks as equal as can be, whatever the records' lengths: that is why the number of
// segments of all must be known before. The same records in the same order give the same bits.
class SumOfRecords {
 public:
  SumOfRecords(std::uint64_t n_segments, std::size_t n_blocks) noexcept : n_expected_(n_segments), n_room_(n_blocks) {}

  // Throws std::invalid_argument with the reason of why_not_addable().
  void add(const RecordSums& record);
  [[nodiscard]] const RecordSums& total() const noexcept { return total_; }

 private:
  void add_blocks(const CpsdSums& sums);

  std::uint64_t n_expected_, n_so_far_ = 0;  // segments
  std::size_t n_room_, place_ = 0;           // of the last block, 0 .. n_room_ - 1
  bool is_empty_ = true, whole_ = true;      // whole: the blocks together are the sums
  RecordSums total_;
};

}  // namespace core
