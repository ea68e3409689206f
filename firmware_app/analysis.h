#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/identification/identifier.h"
#include "core/types/displacement.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "firmware_app/config.h"

namespace app {

// The service's chain from a later point on, in one thread, for the desk: what the tools call.

// Samples of all channels on a uniform grid. NaN = missing.
struct ChannelSeries {
  double rate_hz = 0.0;
  std::vector<core::ChannelInfo> channels;
  std::vector<std::vector<double>> value;  // per channel, equally long
  std::string unit = "units";              // of the values, for people
};

// Spectra and modes of a record, as the service computes them at the end of a run; leaves pictures and report.html in
// `report_directory`, which must exist, when not empty. `source`: what the report names as its input.
// Throws std::invalid_argument when the record is shorter than one segment.
[[nodiscard]] core::ModalEstimate identify_series(const ChannelSeries& series, const SpectrumConfig& spectrum,
                                                  const core::IdentifierConfig& identifier,
                                                  const std::string& report_directory = {},
                                                  const std::string& source = {});

// tracks.csv -> geometry -> spectra -> modes; leaves the service's report in `report_directory` when not empty.
struct TracksResult {
  core::ModalEstimate estimate;
  core::Health losses;
  std::vector<core::ChannelInfo> channels;
};
[[nodiscard]] TracksResult replay_tracks(const AppConfig& config, const std::string& tracks_path,
                                         const std::string& report_directory);

}  // namespace app
