#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/rotors/aircraft.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "core/types/region.h"
#include "firmware_app/config/config.h"

namespace app {

// Contents of modal.json. Of `losses` only the counters that a replay reproduces are written.
struct ModalReport {
  std::string method;                      // "paper" | "hovermodal"
  std::vector<std::string> channel_names;  // of the shapes
  core::ModalEstimate estimate;
  std::vector<std::string> corrections;  // effects that were removed before the identification
  core::Health losses;
  std::vector<std::string> caveats = {};   // what the result leaves open, for a reader
  std::vector<core::Region> regions = {};  // of a run from pictures: name and axis are written
  core::AircraftSummary aircraft = {};     // as its autopilot stated it; written only if known
  bool recovered = false;  // the record includes that of a run that did not come to its end; written only if true
};

[[nodiscard]] std::string_view to_text(Method method) noexcept;
[[nodiscard]] std::string_view to_text(core::FramePrediction prediction) noexcept;     // unknown: empty
[[nodiscard]] core::FramePrediction frame_prediction(std::string_view text) noexcept;  // the inverse

// Text of modal.json: no wall clock, no paths, no busy times, so that the same input gives the same bytes. Unknown
// values are null. `n_not_finite`, if given, receives the number of NaNs and infinities written as null: a fault of
// this program.
[[nodiscard]] std::string modal_json(const ModalReport& report, std::size_t* n_not_finite = nullptr);

// Reads the output of modal_json (also from other programs: missing optional keys are unknown values). Throws
// drivers::FileError naming the file and the key.
[[nodiscard]] ModalReport read_modal_json(const std::string& path);

}  // namespace app
