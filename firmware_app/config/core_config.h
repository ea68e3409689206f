#pragma once

#include <vector>

#include "core/geometry/channel_displacement.h"
#include "core/identification/identifier.h"
#include "core/spectrum/welch_cpsd.h"
#include "core/tracking/structure_tracker.h"
#include "core/types/frame.h"
#include "firmware_app/config/config.h"

namespace app {

// Configuration of each core object, from the one AppConfig. Used by the service and the offline tools, so that a
// replay of tracks uses the same chain.
[[nodiscard]] core::StructureTrackerConfig tracker_config(const AppConfig& config);
// Reads calibration.file when given; throws ConfigError / FileError, also when it does not fit the image.
[[nodiscard]] core::ChannelDisplacementConfig displacement_config(const AppConfig& config,
                                                                  const core::CameraInfo& camera);
[[nodiscard]] core::WelchConfig welch_config(const SpectrumConfig& spectrum, std::size_t n_channels, double rate_hz,
                                             std::size_t n_witnesses = 0);
// Throws ConfigError when identification.references names no channel.
[[nodiscard]] core::IdentifierConfig identifier_config(const AppConfig& config,
                                                       const std::vector<core::ChannelInfo>& channels, double rate_hz);
[[nodiscard]] std::vector<std::string> region_names(const AppConfig& config);
// The corrections in force, described for modal.json.
[[nodiscard]] std::vector<std::string> corrections(const AppConfig& config, const core::CameraInfo& camera);
// Open questions of scale, obliqueness and axes, described for modal.json.
[[nodiscard]] std::vector<std::string> caveats(const AppConfig& config, const core::CameraInfo& camera);

}  // namespace app
