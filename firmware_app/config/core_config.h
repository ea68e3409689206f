#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/channel_displacement.h"
#include "core/identification/identifier.h"
#include "core/rotors/motor_lines.h"
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
// Throws ConfigError where the spectra need more memory than there is.
[[nodiscard]] core::WelchConfig welch_config(const SpectrumConfig& spectrum, std::size_t n_channels, double rate_hz,
                                             std::size_t n_witnesses = 0);
// Bytes that spectra of this configuration take at least, and the refusal (ConfigError) where they exceed those left.
[[nodiscard]] double spectra_bytes(const core::WelchConfig& welch) noexcept;
void require_memory(const core::WelchConfig& welch, double needed_bytes, std::uint64_t left_bytes);
// Throws ConfigError when a frequency of interest folds more than kMostFolds times: the work of an estimate grows with
// the number of folds.
inline constexpr int kMostFolds = 64;
void require_searchable(double max_frequency_hz, double rate_hz);
// Throws ConfigError when identification.references names no channel, and as require_searchable().
[[nodiscard]] core::IdentifierConfig identifier_config(const AppConfig& config,
                                                       const std::vector<core::ChannelInfo>& channels, double rate_hz);
// Reads camera.motors_file when given; throws FileError.
[[nodiscard]] core::MotorLines motor_lines(const AppConfig& config);
[[nodiscard]] std::vector<std::string> region_names(const AppConfig& config);
// The corrections in force, described for modal.json.
[[nodiscard]] std::vector<std::string> corrections(const AppConfig& config, const core::CameraInfo& camera);
// Open questions of scale, obliqueness and axes, described for modal.json.
[[nodiscard]] std::vector<std::string> caveats(const AppConfig& config, const core::CameraInfo& camera);

}  // namespace app
