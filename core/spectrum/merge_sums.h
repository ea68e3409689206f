#pragma once

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
// and row delays (within 0.1 ms) must agree. Others are identified each and their modes combined (merge_setups.h).
[[nodiscard]] std::string why_not_addable(const RecordSums& a, const RecordSums& b);

// The sums of `into` and `from` together, as if the second record had followed the first after a gap: all of the
// estimate is sums and counts. Blocks stand in order; where there are more than `into` has room for, neighbours are
// joined two and two. Throws std::invalid_argument with the reason of why_not_addable().
void add_record(RecordSums& into, const RecordSums& from);

}  // namespace core
