#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/structure/structural_effect.h"

namespace core::structure {

// An effect that changes one of the model's parameters of one role; where there are several (parts, places, supports),
// its first parameter is the number of the place, from 1. Not for shear frames declared without `locate`.
class RoleEffect : public StructuralEffect {
 public:
  struct Form {
    Role role;
    const char *size, *unit;  // of its second parameter; unit empty: that of the model's parameter
    bool is_factor;           // the value is multiplied by the size, else the size times `scale` is added
    std::vector<double> starts;
    double low, high;
    const char* lacking;  // why a model has no such parameter
    const char* instead;
  };
  RoleEffect(std::string_view name, Form form) : name_(name), form_(std::move(form)) {}

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] std::vector<EffectParameter> parameters(const DeclaredFrame& declared) const override;
  [[nodiscard]] std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override;
  void apply(std::span<const double> p, const DeclaredFrame& declared, Eigen::VectorXd& values) const override;
  [[nodiscard]] std::optional<std::size_t> model_parameter(std::span<const double> p,
                                                           const DeclaredFrame& declared) const override;
  [[nodiscard]] std::string implausible(std::span<const double> p, const DeclaredFrame& declared,
                                        const ShearFrame& frame) const override;
  [[nodiscard]] std::string meaning(std::span<const double> p, const DeclaredFrame& declared) const override;

 private:
  // Parameters of the role that may change: a declared value of 0 cannot be multiplied.
  [[nodiscard]] std::vector<std::size_t> places(const StructuralModel& model) const;
  [[nodiscard]] static std::size_t place(std::span<const double> p, std::size_t n);

  std::string_view name_;
  Form form_;
};

}  // namespace core::structure
