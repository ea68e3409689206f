#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"
#include "core/simulation/scene.h"
#include "core/types/closure_result.h"
#include "tools/validate/closure_tracks.h"
#include "tools/validate/closure_tracks_record.h"

namespace tools {

// Residual diagnosis of one record.
struct TracksOutcome {
  core::closure::ClosureResult result;
  std::string words;  // description of the latent effects
  double seconds = 0.0;
  double values = 0.0;  // number of values in the record: points x axes x frames

  [[nodiscard]] double heldout_after() const;
  [[nodiscard]] std::string names() const;       // "a + b", in the order of their names; "nothing"
  [[nodiscard]] std::string parameters() const;  // of all steps
  [[nodiscard]] std::string refused() const;     // the last round: shares of the noise, and why refused
};

// The largest refused candidates of the last round.
struct LargestRefused {
  double named = -1e9, latent = -1e9;  // shares of the noise
  std::string name;
};
[[nodiscard]] LargestRefused largest_refused(const TracksOutcome& outcome);

// Diagnosis of a record; modal errors are relative to the scene's true modes below half the rate. without: an effect
// removed from the catalogue.
[[nodiscard]] TracksOutcome close_tracks_record(const core::closure::ObservationRecord& record,
                                                const core::simulation::Scene& scene, std::uint64_t seed,
                                                const std::string& without = {});
// rms error of frequency, percent, of the model without effects; NaN without a mode.
[[nodiscard]] double plain_modal_error(const core::closure::ObservationRecord& record,
                                       const core::simulation::Scene& scene);

[[nodiscard]] std::uint64_t seed_of(const ClosureTracksOptions& options, std::uint64_t index) noexcept;
[[nodiscard]] RecordSetup setup_for(const ClosureTracksOptions& options);

}  // namespace tools
