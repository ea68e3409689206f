#pragma once

#include <memory>
#include <vector>

#include "core/structure/shear_frame.h"
#include "core/structure/structural_model.h"

namespace core::structure {

// A shear frame (shear_frame.h) as a structural model: a stiffness factor and an additional mass for each storey, and
// its flexibilities. Sights see floors along x: at_m.z is the floor's number from 1. Derivatives are central
// differences: rotations are condensed out.
[[nodiscard]] std::unique_ptr<StructuralModel> make_shear_storeys(const ShearFrame& frame, std::vector<Sight> sights,
                                                                  double part_prior = 0.0);

}  // namespace core::structure
