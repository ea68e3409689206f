// WelchCpsd: blocks for variance estimates, and forgetting.
#include <algorithm>
#include <utility>

#include "core/spectrum/join_blocks.h"
#include "core/spectrum/welch_cpsd.h"

namespace core {

namespace {
using Complex = std::complex<double>;
}  // namespace

void WelchCpsd::fade() noexcept {
  if (kept_per_hop_ == 1.0) return;
  const auto scale = [this](std::vector<Complex>& sum) {
    for (Complex& z : sum) z *= kept_per_hop_;
  };
  scale(sums_.data_sum), scale(sums_.mask_sum);
  sums_.weight.fade(kept_per_hop_);
  sums_.segments.fade(kept_per_hop_);
  for (std::size_t b = 0; b < sums_.n_blocks; ++b) {
    scale(sums_.blocks[b].data_sum), scale(sums_.blocks[b].mask_sum);
    sums_.blocks[b].weight.fade(kept_per_hop_);
  }
}

void WelchCpsd::make_room() noexcept {
  std::vector<CpsdBlock>& blocks = sums_.blocks;
  if (2 * segments_per_block_ > most_segments_per_block_) {
    join_blocks(blocks[0], blocks[1]);
    std::rotate(blocks.begin() + 1, blocks.begin() + 2, blocks.end());
    --sums_.n_blocks;
    return;
  }
  for (std::size_t b = 0; b < blocks.size(); b += 2) {
    join_blocks(blocks[b], blocks[b + 1]);
    std::swap(blocks[b / 2], blocks[b]);
  }
  sums_.n_blocks /= 2;
  segments_per_block_ *= 2;
}

// The last block in use receives the next segment.
CpsdBlock& WelchCpsd::current_block() noexcept {
  std::vector<CpsdBlock>& blocks = sums_.blocks;
  if (sums_.n_blocks > 0 && blocks[sums_.n_blocks - 1].n_segments < segments_per_block_)
    return blocks[sums_.n_blocks - 1];
  if (sums_.n_blocks == blocks.size()) make_room();
  CpsdBlock& next = blocks[sums_.n_blocks++];
  next.n_segments = 0;
  next.weight = {};
  std::fill(next.data_sum.begin(), next.data_sum.end(), Complex());
  std::fill(next.mask_sum.begin(), next.mask_sum.end(), Complex());
  return next;
}

}  // namespace core
