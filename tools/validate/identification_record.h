#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/identification/identifier.h"
#include "core/simulation/scene.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace tools {

// Channel samples of one simulated flight on the frames' grid.
struct Record {
  double rate_hz = 0.0;
  std::vector<core::ChannelInfo> channels;
  std::vector<double> value_mm;    // samples x channels
  std::vector<std::uint8_t> seen;  // samples x channels

  [[nodiscard]] std::size_t n_samples() const noexcept { return channels.empty() ? 0 : seen.size() / channels.size(); }
};

// Displacements of the bodies alone, as ChannelGenerator gives them; dropped frames are missing samples.
[[nodiscard]] Record structure_record(const core::simulation::Scene& scene, bool with_base);

// Image motion of the middle of each region, at 1 px = 1 mm: includes the camera's own motion.
[[nodiscard]] Record image_record(const core::simulation::Scene& scene, bool with_base);

// Without the channels that are not listed.
[[nodiscard]] Record select_channels(const Record& record, const std::vector<std::size_t>& keep);

inline constexpr int kSegment = 1024;
[[nodiscard]] core::CpsdSums spectra(const Record& record, bool bridge_losses = true);

// As if window and losses only scaled the correlations.
[[nodiscard]] core::CpsdSums without_window_correction(core::CpsdSums sums);

// With automatic prewhitening.
[[nodiscard]] core::IdentifierConfig identifier_config(double max_frequency_hz = 0.0);
[[nodiscard]] core::ModalEstimate identify_record(const Record& record, double max_frequency_hz = 0.0,
                                                  bool bridge_losses = true);

}  // namespace tools
