#include <algorithm>
#include <sstream>

#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/plausibility.h"

namespace core::structure {
namespace {

constexpr double kMost_k = 80.0;  // change of temperature of a structure

// Another temperature than that for which the properties are declared: the stiffness of all parts (not of springs) and
// the axial force of restrained bars change by declared coefficients.
class TemperatureChange : public StructuralEffect {
 public:
  [[nodiscard]] std::string_view name() const override { return "temperature"; }
  [[nodiscard]] std::vector<EffectParameter> parameters(const DeclaredFrame&) const override {
    return {{"change", "K", 0.0, {-15.0, 15.0}, -2.0 * kMost_k, 2.0 * kMost_k}};
  }
  [[nodiscard]] std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override {
    if (!declared.temperature) {
      return Obstacle{"how stiffness and axial force depend on temperature is not declared",
                      "declare temperature: {stiffness_per_k, axial_n_per_k}"};
    }
    const bool has_axial = declared.model && declared.temperature->axial_n_per_k != 0.0 &&
                           !parameters_of(*declared.model, Role::kAxialForce).empty();
    if (has_axial) return std::nullopt;
    if (declared.temperature->stiffness_per_k == 0.0)
      return Obstacle{"the model has no axial force that changes with temperature", "declare stiffness_per_k"};
    if (declared.stiffness_over_mass_per_s2) return std::nullopt;
    return Obstacle{"a common factor of all frequencies, which stiffness over mass absorbs",
                    "declare stiffness: known, or axial_n_per_k of a cable or a restrained beam"};
  }
  void apply(std::span<const double> p, const DeclaredFrame& declared, ShearFrame& frame) const override {
    for (double& k : frame.stiffness_per_s2) k *= factor(p[0], declared);
  }
  void apply(std::span<const double> p, const DeclaredFrame& declared, Eigen::VectorXd& values) const override {
    const auto change = [&](std::size_t i, double value) {
      const ModelParameter& parameter = declared.model->parameters()[i];
      values(static_cast<Eigen::Index>(i)) = std::clamp(value, parameter.low, parameter.high);
    };
    for (const std::size_t i : parameters_of(*declared.model, Role::kPartStiffness))
      change(i, values(static_cast<Eigen::Index>(i)) * factor(p[0], declared));
    for (const std::size_t i : parameters_of(*declared.model, Role::kAxialForce))
      change(i, values(static_cast<Eigen::Index>(i)) + p[0] * declared.temperature->axial_n_per_k);
  }
  [[nodiscard]] std::string implausible(std::span<const double> p, const DeclaredFrame&,
                                        const ShearFrame&) const override {
    return outside(p[0], -kMost_k, kMost_k, "a change of temperature (K)");
  }
  [[nodiscard]] std::string meaning(std::span<const double> p, const DeclaredFrame& declared) const override {
    std::ostringstream text;
    text.precision(3);
    text << "stiffness " << 100.0 * (factor(p[0], declared) - 1.0) << " %";
    if (const double newton = p[0] * declared.temperature->axial_n_per_k; newton != 0.0)
      text << ", axial force " << newton << " N";
    return text.str();
  }

 private:
  static double factor(double kelvin, const DeclaredFrame& declared) {
    return std::max(1.0 + kelvin * declared.temperature->stiffness_per_k, 1e-3);
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_temperature() { return std::make_unique<TemperatureChange>(); }

}  // namespace core::structure
