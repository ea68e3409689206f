#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace core::structure {

// Declared properties of a shear frame; lowest storey first. Empty = unknown.
struct DeclaredFrame {
  std::size_t n_storeys = 0;
  std::vector<double> mass;             // relative, one per storey; empty: all equal
  std::vector<double> stiffness_ratio;  // relative, one per storey; empty: all equal
  std::optional<double> storey_height_mm;
  // For stiffness ratio 1 over mass 1. Empty: fitted; a common factor of all frequencies then carries no information.
  std::optional<double> stiffness_over_mass_per_s2;
  bool simulated = false;           // the reference comes from a simulation: its integrator may shift frequencies
  std::optional<double> dt_s;       // step of that integrator
  double frequency_sigma = 0.0015;  // of a reference frequency that has no sigma, relative
  double shape_sigma = 0.02;        // of a shape component that has no sigma; the largest component is 1
  std::vector<std::string> floors;  // names of the reference's channels, one per storey; empty: shapes are not compared
};

// A mode from a measurement or from another program.
struct ReferenceMode {
  int number = 0;  // of the corresponding mode of the model, from 1 by frequency
  double frequency_hz = 0.0;
  double sigma_hz = 0.0;
  std::vector<double> shape;        // per storey, largest component 1; empty: unknown
  std::vector<double> shape_sigma;  // one per component
};

inline constexpr std::size_t kMaxStoreys = 100;

// Throws std::invalid_argument with the value, the allowed range and a remedy.
void validate(const DeclaredFrame& frame);
void validate(const DeclaredFrame& frame, const std::vector<ReferenceMode>& reference);

}  // namespace core::structure
