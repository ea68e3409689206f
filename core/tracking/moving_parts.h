#pragma once

#include <vector>

#include "core/tracking/region_proposal.h"
#include "core/types/vector2.h"

namespace core {

// A part that was found, with its motion.
struct MovingPart {
  ProposedRegion proposed;
  std::vector<Vector2> motion;  // px, one per frame
  double merit = 0.0;           // how much it moves like a structure: see rate_parts
};

// A structure moves in a few ways, its modes: the motion of its parts along their axes, each of unit rms, has a few large
// principal components. Sets proposed.shared, the share of a part's motion that the three largest explain, and merit:
// that share, less where the motion hardly exceeds the part's noise. The parts have equally many frames.
void rate_parts(std::vector<MovingPart>& parts);

// 0.05 (they move alike) ... 1: how much of the motion of either is not the other's.
[[nodiscard]] double unlike(const MovingPart& a, const MovingPart& b);

}  // namespace core
