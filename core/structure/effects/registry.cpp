#include <sstream>

#include "core/structure/effects/all.h"

namespace core::structure {

const std::vector<std::unique_ptr<StructuralEffect>>& structural_effects() {
  static const std::vector<std::unique_ptr<StructuralEffect>> kAll = [] {
    std::vector<std::unique_ptr<StructuralEffect>> all;
    all.push_back(make_ground_storey());
    all.push_back(make_gravity_softening());
    all.push_back(make_joint_rotation());
    all.push_back(make_base_rocking());
    all.push_back(make_roof_mass());
    all.push_back(make_column_bending());
    all.push_back(make_stiffness_scale());
    all.push_back(make_integrator());
    all.push_back(make_clock_rate());
    return all;
  }();
  return kAll;
}

ShearFrame uniform_frame(const DeclaredFrame& declared, double stiffness_over_mass_per_s2) {
  ShearFrame frame;
  frame.mass = declared.mass.empty() ? std::vector<double>(declared.n_storeys, 1.0) : declared.mass;
  frame.stiffness_per_s2 =
      declared.stiffness_ratio.empty() ? std::vector<double>(declared.n_storeys, 1.0) : declared.stiffness_ratio;
  for (double& k : frame.stiffness_per_s2) k *= stiffness_over_mass_per_s2;
  return frame;
}

std::string outside(double value, double low, double high, std::string_view what) {
  if (value >= low && value <= high) return {};
  std::ostringstream text;
  text.precision(3);
  text << what << " of " << value << " is outside " << low << " .. " << high;
  return text.str();
}

std::optional<Obstacle> needs_storeys(const DeclaredFrame& declared, std::size_t n) {
  if (declared.n_storeys >= n) return std::nullopt;
  return Obstacle{"with so few storeys it is a common factor of all frequencies, which stiffness over mass absorbs",
                  "measure the stiffness or the masses"};
}

}  // namespace core::structure
