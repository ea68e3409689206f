#pragma once

#include <complex>
#include <string>
#include <vector>

#include "firmware_app/report/modal_json.h"

namespace app {

// Modes of two results side by side, by the names of their channels: for `compare` and for the page of a run.

// Channels whose components are known in both, in the order of `a`.
[[nodiscard]] std::vector<std::string> common_channels(const ModalReport& a, const ModalReport& b);

// Components of `mode`, a mode of `report`, for the channels of `names`; 0 for a channel that does not exist.
[[nodiscard]] std::vector<std::complex<double>> shape_for(const ModalReport& report, const core::Mode& mode,
                                                          const std::vector<std::string>& names);

struct ModeMatch {
  const core::Mode* mode = nullptr;  // borrowed from the report; null: none within 10 % in frequency
  double mac = 0.0;                  // over the channels of `names`
};
// The mode of `report` that corresponds to `wanted`: among those within 10 % in frequency the one with the best MAC.
[[nodiscard]] ModeMatch find_mode(const ModalReport& report, const core::Mode& wanted,
                                  const std::vector<std::string>& names,
                                  const std::vector<std::complex<double>>& wanted_shape);

}  // namespace app
