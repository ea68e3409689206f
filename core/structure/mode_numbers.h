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

// Which of a model's modes each reference mode is.
struct Pairing {
  std::vector<int> number;  // of each reference mode, from 1; 0: none
  double cost = 0.0;        // of all of them
  double worst = 0.0;       // of the worst pair: 1 is a tenth of the frequency or a fifth of the MAC, 4 the limit
};

// Pairs of least cost, of frequency and MAC where shapes are known. `hz`, `shapes` (components x modes): the model's.
// `any_factor`: a common factor of all frequencies is allowed.
[[nodiscard]] Pairing pair_modes(const Eigen::VectorXd& hz, const Eigen::MatrixXd& shapes, bool any_factor,
                                 const std::vector<ReferenceMode>& reference);
// Those that have a number, under it, in their order.
[[nodiscard]] std::vector<ReferenceMode> numbered(std::vector<ReferenceMode> reference, const std::vector<int>& number);

// Gives each reference mode its number in the declared model. Those that pair with none are removed and returned; both
// stay in their order.
std::vector<ReferenceMode> pair_with_model(const DeclaredFrame& declared, std::vector<ReferenceMode>& reference);

}  // namespace core::structure
