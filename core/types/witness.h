#pragma once

#include "core/types/displacement.h"

namespace core {

// A witness without a direction measures the camera's rotation about its optical axis: what that rotation does half the
// image's height away from its centre.
[[nodiscard]] inline bool witnesses_turn(const ChannelInfo& channel) noexcept {
  return channel.is_witness && channel.direction_u == 0.0 && channel.direction_v == 0.0;
}

// Cosine of the angle between two axes.
[[nodiscard]] inline double cosine_between(const ChannelInfo& a, const ChannelInfo& b) noexcept {
  return a.direction_u * b.direction_u + a.direction_v * b.direction_v;
}

}  // namespace core
