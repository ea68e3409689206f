#pragma once

#include <complex>
#include <vector>

namespace core {

// Range of rotor and blade frequencies; the exposure averages out faster vibration.
inline constexpr double kFastestCamera_hz = 250.0;

// Share of an observed shape's square, 0 ... 1, that a camera explains which vibrates at this frequency: a translation
// and a rotation about the optical axis (a constant and a slope along the rows), each with a phase of its own, seen by
// every channel at its row delay. At least one channel; as many delays as components. frequency_hz: signed.
[[nodiscard]] double camera_share(const std::vector<std::complex<double>>& observed, double frequency_hz,
                                  const std::vector<double>& delay_s);

// Similarity of the phases that two frequencies this far apart cause in the channels, 0 ... 1.
[[nodiscard]] double phase_likeness(double apart_hz, const std::vector<double>& delay_s);

}  // namespace core
