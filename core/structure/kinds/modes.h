#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/structure/structural_model.h"

namespace core::structure {

// Modes and their sensitivities from another program: f_r = f_r0 (1 + sum s_ri (p_i - 1)), shapes as given. Valid for
// small changes only.
struct ModeTable {
  struct Mode {
    double frequency_hz = 0.0;
    std::vector<double> shape;        // one per channel; empty: unknown
    std::vector<double> sensitivity;  // relative change of frequency over that of each parameter
  };
  std::vector<std::string> channels, parameters;
  std::vector<Mode> modes;  // ascending
  double prior = 0.0;       // relative standard deviation of each parameter
};

// Throws std::invalid_argument.
[[nodiscard]] std::unique_ptr<StructuralModel> make_modes(const ModeTable& table);

}  // namespace core::structure
