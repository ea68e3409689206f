#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/closure/observation/fit_view.h"
#include "core/types/closure_result.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core::closure {

// Channels of the regions' motion in a fit.
struct RegionChannels {
  std::vector<core::ChannelInfo> info;
  std::vector<Eigen::Index> rows;  // of the model's amplitudes
};
[[nodiscard]] RegionChannels region_channels(const FitView& fit);

// Modes of the regions' motion, identified from a fit.
[[nodiscard]] core::ModalEstimate region_modes(const FitView& fit);

// Identified modes for a reader. With a reference: its modes, each with the nearest identified mode within 5 % of its
// frequency (frequency 0 if there is none).
[[nodiscard]] std::vector<ClosureMode> compared_modes(const std::vector<core::Mode>& found,
                                                      const std::vector<core::Mode>& reference);
// rms error over the modes with a reference, percent of frequency; empty: none.
[[nodiscard]] std::optional<double> rms_error_percent(const std::vector<ClosureMode>& modes);

}  // namespace core::closure
