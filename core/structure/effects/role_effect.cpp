#include "core/structure/effects/role_effect.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/structure/effects/plausibility.h"

namespace core::structure {

std::vector<std::size_t> RoleEffect::places(const StructuralModel& model) const {
  std::vector<std::size_t> out = parameters_of(model, form_.role);
  if (form_.is_factor) std::erase_if(out, [&](std::size_t i) { return model.parameters()[i].value == 0.0; });
  // A declared spring is multiplied; a hinge is given one.
  if (!form_.is_factor && form_.role == Role::kSpring)
    std::erase_if(out, [&](std::size_t i) { return model.parameters()[i].value != 0.0; });
  return out;
}

std::size_t RoleEffect::place(std::span<const double> p, std::size_t n) {
  if (p.size() < 2) return 0;
  return static_cast<std::size_t>(std::clamp(std::lround(p[0]), 1L, static_cast<long>(n))) - 1;
}

std::vector<EffectParameter> RoleEffect::parameters(const DeclaredFrame& declared) const {
  std::vector<EffectParameter> out;
  const std::size_t n = declared.model ? places(*declared.model).size() : 0;
  if (n > 1) {
    EffectParameter where{"place", "number", 0.0, {}, 1.0, static_cast<double>(n), true};
    for (std::size_t i = 1; i <= n; ++i) where.starts.push_back(static_cast<double>(i));
    out.push_back(std::move(where));
  }
  out.push_back({form_.size, form_.unit, form_.is_factor ? 1.0 : 0.0, form_.starts, form_.low, form_.high, false});
  return out;
}

std::optional<Obstacle> RoleEffect::obstacle(const DeclaredFrame& declared) const {
  if (!declared.model) return Obstacle{kOtherKind, "declare locate: true to search a shear frame's storeys"};
  const std::size_t n = places(*declared.model).size();
  if (n == 0) return Obstacle{form_.lacking, form_.instead};
  const bool whole = declared.model->kind() != "matrices" && declared.model->kind() != "modes";
  if (form_.role == Role::kPartStiffness && n == 1 && whole && !declared.stiffness_over_mass_per_s2)
    return Obstacle{"one part is the whole: its stiffness is fitted from the beginning", "declare more parts"};
  return std::nullopt;
}

void RoleEffect::apply(std::span<const double> p, const DeclaredFrame& declared, Eigen::VectorXd& values) const {
  const StructuralModel& model = *declared.model;
  const std::vector<std::size_t> all = places(model);
  if (all.empty()) return;
  const std::size_t i = all[place(p, all.size())];
  double& value = values(static_cast<Eigen::Index>(i));
  const ModelParameter& parameter = model.parameters()[i];
  value = std::clamp(form_.is_factor ? value * p.back() : value + p.back() * parameter.scale, parameter.low,
                     parameter.high);
}

std::optional<std::size_t> RoleEffect::model_parameter(std::span<const double> p, const DeclaredFrame& declared) const {
  if (!declared.model) return std::nullopt;
  const std::vector<std::size_t> all = places(*declared.model);
  if (all.empty()) return std::nullopt;
  return all[place(p, all.size())];
}

std::string RoleEffect::implausible(std::span<const double> p, const DeclaredFrame& declared, const ShearFrame&) const {
  if (!declared.model) return {};
  const auto [low, high] = std::pair(form_.low, form_.high);
  const double size = p.back(), margin = 1e-9 * (high - low);
  if (!form_.is_factor && low == 0.0 && !(size > 0.0)) return "it would have to be negative";
  return size > low + margin && size < high - margin ? "" : outside(size, low + margin, high - margin, form_.size);
}

std::string RoleEffect::meaning(std::span<const double> p, const DeclaredFrame& declared) const {
  if (!declared.model) return {};
  const std::vector<std::size_t> all = places(*declared.model);
  if (all.empty()) return {};
  const ModelParameter& parameter = declared.model->parameters()[all[place(p, all.size())]];
  std::ostringstream text;
  text.precision(4);
  text << parameter.name;
  if (!parameter.place.empty()) text << " (" << parameter.place << ")";
  if (form_.is_factor) {
    text << " at " << p.back() << " of its declared value";
  } else {
    text << " = " << parameter.value + p.back() * parameter.scale << ' ' << parameter.unit;
  }
  return text.str();
}

}  // namespace core::structure
