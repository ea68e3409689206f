#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/closure/closure_level.h"
#include "core/types/closure_result.h"
#include "core/types/loop_progress.h"

namespace core::closure {

struct ClosureOptions {
  std::size_t n_surrogates = 333;  // per step; 333 is the smallest number whose largest score is the 99.7 % level
  // Early stop: after this many surrogates, draw no more if the best score already exceeds three times the threshold
  // that they imply. 0 = never stop early. For levels whose surrogates are costly.
  std::size_t n_surrogates_when_plain = 0;
  std::uint64_t seed = 1;
  std::size_t max_steps = 8;
  // In the level's unit, rms: an effect is not adopted where both the drop of the held-out error and what it changes in
  // the data (ClosureLevel::size_of) are smaller. Quantities that are free in the model absorb a part of most effects.
  double least_gain = 0.0;
  TellProgress progress = {};  // called at the start of each part, and after each surrogate
};

// Probability that an effect is adopted in a record that contains none.
inline constexpr double kChance = 0.003;

// Threshold that the largest score of all candidates exceeds by chance with probability kChance: of n surrogates the
// k-th largest score, k = kChance (n + 1), exact for any distribution. With fewer than 333 surrogates it is computed
// from a Gumbel distribution of the same mean and standard deviation (mean + 4.08 sd). `scores` must not be empty.
[[nodiscard]] double chance_threshold(std::vector<double> scores);

// Fit -> residual -> structured? -> score every candidate on held-out data -> adopt the best that exceeds the chance
// threshold and is material -> refit all, revert if the held-out error did not fall -> repeat. Of two scores within 1 %
// the candidate with fewer parameters is adopted. Rivals are determined in the final model. Throws
// std::invalid_argument on too few surrogates; exceptions of the level pass through.
[[nodiscard]] ClosureResult close_loop(ClosureLevel& level, const ClosureOptions& options = {});

}  // namespace core::closure
