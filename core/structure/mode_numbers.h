#pragma once

#include <string>
#include <vector>

#include "core/structure/declared_frame.h"

namespace core::structure {

// Modal assurance criterion of two real shapes; 0 if one is zero.
[[nodiscard]] double mac(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

// Exchanges neighbouring modes within a tenth of each other's frequency where their shapes then agree better with those
// of `known`.
void number_as(const ModelModes& known, ModelModes& modes);

// Gives each reference mode the number of the declared model's mode that it is: pairs of least cost, of frequency (a
// tenth; a common factor is allowed unless stiffness is known) and MAC where shapes are known. Reference modes that
// pair with none are removed and returned, lowest first: frequencies in Hz.
std::vector<double> pair_with_model(const DeclaredFrame& declared, std::vector<ReferenceMode>& reference);

}  // namespace core::structure
