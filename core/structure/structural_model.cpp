#include "core/structure/structural_model.h"

namespace core::structure {

Eigen::VectorXd declared_values(const StructuralModel& model) {
  const auto& parameters = model.parameters();
  Eigen::VectorXd out(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) out(static_cast<Eigen::Index>(i)) = parameters[i].value;
  return out;
}

std::vector<std::size_t> parameters_of(const StructuralModel& model, Role role) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < model.parameters().size(); ++i) {
    if (model.parameters()[i].role == role) out.push_back(i);
  }
  return out;
}

}  // namespace core::structure
