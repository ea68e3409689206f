#pragma once

#include <optional>
#include <string>
#include <vector>

namespace app {

// One mode as measured and as the structural model has it. Components per channel, at the scale at which the measured
// ones have a largest component of 1; one value per channel in each vector.
struct ShapeComparison {
  int number = 0;
  double measured_hz = 0.0, before_hz = 0.0, after_hz = 0.0;
  std::vector<double> measured, sigma, before, after;
  std::optional<double> mac_before, mac_after;
};

// One place (part, node, support) at which an effect was sought.
struct SoughtPlace {
  std::string name;                   // as the report calls it, with the value fitted there
  double excess_chi2 = 0.0;           // over the best place; infinite: no fit
  bool is_found = false;              // where the effect was found
  bool is_indistinguishable = false;  // the modes cannot distinguish it from that place
};

// A line or node of the drawing of a structure, m; x to the right, z upwards.
struct DrawnPart {
  double from_x = 0.0, from_z = 0.0, to_x = 0.0, to_z = 0.0;
  bool is_member = false;             // of the structure as declared: always drawn
  std::string found;                  // label of what was found there; empty: nothing
  bool is_indistinguishable = false;  // it may as well be here
};
struct SeenPlace {
  double x = 0.0, z = 0.0;
};

// A fitted parameter: of the model with a prior, or of an adopted effect (no prior).
struct FittedParameter {
  std::string name, unit;
  double value = 0.0;
  std::optional<double> sigma;  // empty: at a bound or not determined
  std::optional<double> declared, prior_sigma;
};

// Complete SVG files; empty text where there is nothing to draw. Pure; any thread.
// Measured and computed shapes side by side, one panel per mode.
[[nodiscard]] std::string structure_shapes_svg(const std::vector<ShapeComparison>& modes,
                                               const std::vector<std::string>& channels);
// The structure's places from the first (lowest) upwards, with what was found marked on it.
[[nodiscard]] std::string structure_places_svg(const std::string& effect, const std::vector<SoughtPlace>& places);
// The structure to scale with what was found marked on it, and the places that are seen.
[[nodiscard]] std::string structure_drawing_svg(const std::vector<DrawnPart>& parts,
                                                const std::vector<SeenPlace>& seen);
// Each parameter with one and two standard deviations, in units of its prior's about the declared value; one without a
// prior in units of its own value.
[[nodiscard]] std::string structure_posterior_svg(const std::vector<FittedParameter>& parameters);

}  // namespace app
