#pragma once

#include <string>
#include <vector>

namespace tools {

// A six-storey frame with one departure from the uniform shear frame, put together by core/simulation and beam
// elements: nothing of core/structure in it.
struct KnownStructure {
  std::string effect;  // as closing the loop calls it; "none"
  std::vector<double> frequency_hz;
  bool simulated = false;
};
[[nodiscard]] std::vector<KnownStructure> known_structures();

}  // namespace tools
