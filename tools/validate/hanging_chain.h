#pragma once

#include <Eigen/Core>
#include <vector>

namespace tools {

// A stay cable as a chain of elastic bars with masses at their ends, hanging at rest under its weight: the truth for
// figures of tension. Shares no equation with core/structure/kinds/cable: no parabola, no string, no shape functions.
// Both ends are held in displacement and rotation.
struct HangingChain {
  double chord_m = 100.0, slope_deg = 30.0;  // of the straight line between its ends against the horizontal
  double mass_per_m_kg = 60.0;               // of the length as it hangs
  double tension_n = 3.0e6;                  // mean over the length
  double ei_nm2 = 5.0e5, ea_n = 1.0e9;
  int n_bars = 1200;
};

struct ChainModes {
  Eigen::VectorXd frequency_hz;  // in the vertical plane, ascending
  Eigen::MatrixXd shapes;        // places x modes, normal to the chord; modal mass 1 kg
  double sag_m = 0.0;            // largest distance from the chord
};
// `places`: shares of the chord, 0 .. 1. Throws std::runtime_error where the chain finds no rest.
[[nodiscard]] ChainModes chain_modes(const HangingChain& chain, const std::vector<double>& places, int n_modes);

}  // namespace tools
