#pragma once

#include "tools/validate/geometry.h"

namespace tools {

// Whether every mode of a record is found, and whether its stated intervals hold: the paper's experiment with a drawn
// hover and readout time, on a shaken base (white, or with peaks of its own) and in the wind. Prints tab-separated
// lines.
void print_trust_modes(const GeometryOptions& options);

// The same for the shaken base and the wind with lost frames, and under a camera that vibrates.
void print_trust_disturbed(const GeometryOptions& options);

// Modes found under a camera that shakes and turns, and under the hover alone, by each way of following the camera.
void print_trust_camera(const GeometryOptions& options);

// Modes of drawn storeys that are found in the full record, and of them those found after frames were lost one by one
// or in bursts of one to ten.
void print_trust_losses(const GeometryOptions& options);

}  // namespace tools
