#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/structure/declared_frame.h"
#include "core/structure/shear_frame.h"

namespace core::structure {

struct EffectParameter {
  std::string name, unit;
  double neutral = 0.0;          // value without the effect
  std::vector<double> starts;    // initial values of the fit; the best result is used
  double low = 0.0, high = 0.0;  // bounds of the fit
  bool is_place = false;         // number of a place: takes its initial values only
};

// Reason of an effect that has no meaning for the declared kind.
inline constexpr const char* kOtherKind = "an effect of another kind of structure";

struct Obstacle {
  std::string reason;   // why the effect is not observable
  std::string instead;  // what would make it observable
};

// One physical cause that may be missing in a model: one file and one line in effects/catalogue.h. Stateless.
class StructuralEffect {
 public:
  StructuralEffect() = default;
  StructuralEffect(const StructuralEffect&) = delete;
  StructuralEffect& operator=(const StructuralEffect&) = delete;
  virtual ~StructuralEffect() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;
  // May be empty, if the declaration gives all values.
  [[nodiscard]] virtual std::vector<EffectParameter> parameters(const DeclaredFrame& declared) const = 0;
  // Empty: observable in frequencies and shapes of such a frame.
  [[nodiscard]] virtual std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const = 0;
  // Applies the effect to the frame, in the order of adoption; each effect changes a field of its own.
  virtual void apply(std::span<const double> /*parameters*/, const DeclaredFrame&, ShearFrame&) const {}
  // The same for another kind of model (declared.model): changes the values of its parameters.
  virtual void apply(std::span<const double> /*parameters*/, const DeclaredFrame&, Eigen::VectorXd& /*values*/) const {}
  // Index of the one parameter of declared.model that these values change; empty: several, or another kind.
  [[nodiscard]] virtual std::optional<std::size_t> model_parameter(std::span<const double> /*parameters*/,
                                                                   const DeclaredFrame&) const {
    return std::nullopt;
  }
  // Frequency at which a frequency of the frame is observed.
  [[nodiscard]] virtual double seen_hz(double frequency_hz, std::span<const double> /*parameters*/,
                                       const DeclaredFrame&) const {
    return frequency_hz;
  }
  [[nodiscard]] virtual bool changes_frequencies() const { return false; }  // whether seen_hz() does
  // Empty if the fitted values are plausible; else the reason why not. `frame` is the fitted shear frame
  // with all effects.
  [[nodiscard]] virtual std::string implausible(std::span<const double> parameters, const DeclaredFrame& declared,
                                                const ShearFrame& frame) const = 0;
  // Implication of the parameters for a reader: "a storey height of 118 mm". May be empty.
  [[nodiscard]] virtual std::string meaning(std::span<const double> /*parameters*/, const DeclaredFrame&) const {
    return {};
  }
};

}  // namespace core::structure
