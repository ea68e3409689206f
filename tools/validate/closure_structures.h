#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/validate/closure_effects.h"

namespace tools {

// A frame of 4 to 8 storeys with one departure from the uniform shear frame, drawn from a seed and built by
// core/simulation and beam elements, without any code of core/structure.
struct KnownStructure {
  std::string effect;  // name in residual diagnosis; "none"
  std::vector<double> frequency_hz;
  std::vector<KnownValue> truth;  // its parameters
  bool simulated = false;
};
[[nodiscard]] const std::vector<std::string>& known_structures();  // the effects; "none" first
[[nodiscard]] KnownStructure known_structure(const std::string& effect, std::uint64_t seed);

}  // namespace tools
