#pragma once

#include <optional>
#include <vector>

#include "core/compare/sensor_comparison.h"

namespace core {

// Welch densities and coherence of the two records, the sensor at the camera's instants, within the band. n_averages:
// segments, which overlap by half.
[[nodiscard]] std::vector<ComparedBin> compared_spectrum(const BandLimited& camera, const BandLimited& sensor,
                                                         const ClockAlignment& alignment, const Band& band,
                                                         double camera_rate_hz, int& n_averages);

// From the lowest to the highest bin in which at least half of the power is common to both records, and more than
// chance makes so once in 10 000, two bins wider on either side. Empty: there is none.
[[nodiscard]] std::optional<Band> coherent_band(const std::vector<ComparedBin>& spectrum, const Band& searched,
                                                int n_averages);

// Mean over the band, weighted by the camera's power.
[[nodiscard]] double band_coherence(const std::vector<ComparedBin>& spectrum, const Band& band);

}  // namespace core
