#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/structure/structural_model.h"

namespace core::structure {

// How properties depend on temperature: relative change of the stiffness of all parts, and change of the axial force of
// restrained bars and cables (of a rigidly held bar -E A times its expansion), per kelvin.
struct TemperatureLaw {
  double stiffness_per_k = 0.0, axial_n_per_k = 0.0;
};

// Declared properties of a structure. Fields without further remark belong to a shear frame, lowest storey first. Empty
// = unknown.
struct DeclaredFrame {
  // Another kind than a shear frame (kinds/), or a shear frame whose storeys are searched for the place of an effect.
  // Its parameters with a prior are fitted; those without keep their declared values unless an effect changes them.
  std::shared_ptr<const StructuralModel> model;
  std::shared_ptr<const ModelModes> numbering;  // its modes as declared: numbers of modes follow these shapes
  std::size_t n_storeys = 0;            // of another kind: number of modes that are computed and may be referred to
  std::vector<double> mass;             // relative, one per storey; empty: all equal
  std::vector<double> stiffness_ratio;  // relative, one per storey; empty: all equal
  std::optional<double> storey_height_mm;
  // For stiffness ratio 1 over mass 1. Empty: fitted; a common factor of all frequencies then carries no information.
  // Another kind: any value declares that its stiffness and mass are known absolutely.
  std::optional<double> stiffness_over_mass_per_s2;
  std::optional<TemperatureLaw> temperature;
  bool simulated = false;           // the reference comes from a simulation: its integrator may shift frequencies
  std::optional<double> dt_s;       // step of that integrator
  double frequency_sigma = 0.0015;  // of a reference frequency that has no sigma, relative
  double shape_sigma = 0.02;        // of a shape component that has no sigma; the largest component is 1
  // Names of the reference's channels, one per storey or sight of the model; empty: shapes are not compared.
  std::vector<std::string> floors;

  [[nodiscard]] std::size_t n_components() const noexcept { return model ? model->sights().size() : n_storeys; }
};

// A mode from a measurement or from another program.
struct ReferenceMode {
  int number = 0;  // of the corresponding mode of the model, from 1 by frequency
  double frequency_hz = 0.0;
  double sigma_hz = 0.0;
  std::vector<double> shape;        // per storey or sight, largest component 1; empty: unknown
  std::vector<double> shape_sigma;  // one per component
  std::optional<double> damping_ratio;
  double damping_sigma = 0.0;  // 0: unknown
};

inline constexpr std::size_t kMaxStoreys = 100;

// A structure of any kind, compared in its lowest `n_modes`. Throws std::invalid_argument if the declared model has no
// modes.
[[nodiscard]] DeclaredFrame declare(std::shared_ptr<const StructuralModel> model, std::size_t n_modes);

// Throws std::invalid_argument with the value, the allowed range and a remedy.
void validate(const DeclaredFrame& frame);
void validate(const DeclaredFrame& frame, const std::vector<ReferenceMode>& reference);

}  // namespace core::structure
