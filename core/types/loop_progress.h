#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace core::closure {

// What residual diagnosis is doing. Where its parts are counted, `n_done` of `n` are over; n = 0: not known.
struct LoopProgress {
  std::string words;
  std::size_t n_done = 0, n = 0;
};
using TellProgress = std::function<void(const LoopProgress&)>;

}  // namespace core::closure
