#pragma once

#include <vector>

#include "core/tracking/region_proposal.h"
#include "core/types/vector2.h"

namespace core {

// A moving part of the picture, with its motion.
struct MovingPart {
  ProposedRegion proposed;
  std::vector<Vector2> motion;  // px, one per frame
  double merit = 0.0;           // similarity of its motion to that of a structure: see rate_parts
};

// A structure moves in a few modes: the motion of its parts along their axes, each normalised to unit rms, has a few
// large principal components. Sets proposed.shared, the share of a part's motion that the three largest explain, and
// merit: that share, reduced if the motion hardly exceeds the part's noise. All parts have equally many frames.
void rate_parts(std::vector<MovingPart>& parts);

// Dissimilarity of two motions: 0.05 (they move alike) ... 1.
[[nodiscard]] double unlike(const MovingPart& a, const MovingPart& b);

}  // namespace core
