#pragma once

#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// Channels that are inputs of the identification (EraConfig::inputs), in ascending order. With u the ground's and c the
// camera's motion, a channel moves by G (u + c) + (1 - G) c, G the response to the ground: the base measures u + c and
// a region at rest c, and given both of them G is left. Without a base, only the camera's rotation about its optical
// axis is an input: a region at rest does not determine its translation in the structure's plane.
//
// A base is no input if it moves in a part of the record only: given an earthquake, the little that the rest of the
// record holds is lost. A region declared static is no input if it explains half of the channels' motion against one
// another: then it moves with the structure, and its rotation is no input either.
[[nodiscard]] std::vector<int> measured_inputs(const CpsdSums& sums, const std::vector<ChannelInfo>& channels);

}  // namespace core
