#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/closure/closure_level.h"
#include "core/types/closure_result.h"

namespace core::closure {

struct ClosureOptions {
  std::size_t n_surrogates = 333;  // per step; the fewest whose largest score is the 99.7 % level
  // A step whose best score is three times what the first so many say of chance draws no more of them; 0 = it draws
  // all. For levels whose surrogates are costly.
  std::size_t n_surrogates_when_plain = 0;
  std::uint64_t seed = 1;
  std::size_t max_steps = 8;
  double least_gain = 0.0;  // in the level's unit: a step that takes out less (rms, held out) is not worth telling
  std::function<void(const std::string&)> progress = {};  // told in words what is being done
};

// Chance adopts in at most three of a thousand records.
inline constexpr double kChance = 0.003;

// The level that the maximum over all candidates exceeds by chance with probability kChance: of n surrogates the k-th
// largest, k = kChance (n + 1), exact whatever their distribution. With fewer than 333 a Gumbel distribution of the
// same mean and standard deviation is read instead (mean + 4.08 sd). `scores` must not be empty.
[[nodiscard]] double chance_threshold(std::vector<double> scores);

// Fit -> residual -> structured? -> score every candidate on held-out data -> adopt the best that beats chance and is
// material -> refit all together, revert where the held-out error did not fall -> repeat. Where two scores differ by
// less than 1 % the candidate of fewer parameters is taken. Rivals are told in the final model. Throws
// std::invalid_argument on options that ask for nothing; what the level throws passes through.
[[nodiscard]] ClosureResult close_loop(ClosureLevel& level, const ClosureOptions& options = {});

}  // namespace core::closure
