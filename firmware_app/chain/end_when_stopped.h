#pragma once

#include <functional>
#include <stdexcept>
#include <utility>

#include "core/types/loop_progress.h"

namespace app {

// Progress that asks `goes_on`, and throws std::runtime_error("stopped") once it returns false.
[[nodiscard]] inline core::closure::TellProgress end_when_stopped(std::function<bool()> goes_on) {
  return [goes_on = std::move(goes_on)](const core::closure::LoopProgress&) {
    if (!goes_on()) throw std::runtime_error("stopped");
  };
}

}  // namespace app
