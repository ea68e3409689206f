#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/closure/observation/run_correction.h"
#include "core/types/closure_report.h"

namespace core::closure {

// An effect that a run corrects in its own points.
struct EffectInForce {
  EffectId id;
  std::string effect;  // its name
  std::vector<ParameterValue> parameters;
  std::uint64_t from_sequence = 0;  // first frame to which it applies
};

// Decides from consecutive reports of the observation level which effects a run corrects in its own points. Reports are
// computed from the points as measured, so a corrected effect is found again as long as the correction helps. An effect
// is corrected if it supports this (ObservationEffect::in_flight) and two consecutive reports name it with equal values
// and without a rival. It is withdrawn if a report made entirely of later frames does not find it. All other effects
// are reported but not corrected.
class Adoption {
 public:
  static constexpr double kSameSigmas = 5.0, kSameShare = 0.1;  // two values are equal within either limit

  // Descriptions of the changes caused by this report, valid from from_sequence on. Empty: nothing changes.
  [[nodiscard]] std::vector<std::string> update(const ClosureReport& report, std::uint64_t from_sequence);

  [[nodiscard]] const std::vector<EffectInForce>& in_force() const noexcept { return in_force_; }
  // For example "readout time: added readout = 0.56 +- 0.001 frames, from frame 3600 on".
  [[nodiscard]] std::vector<std::string> words() const;
  // Sum of all effects in force. camera: the camera of the record from which the reports are computed.
  [[nodiscard]] RunCorrection correction(const CameraModel& camera) const;
  // True if the last update changed the row delays themselves, and not only their precision: an effect that changes
  // them was missing in at least one report since the first.
  [[nodiscard]] bool changes_delays() const noexcept { return changes_delays_; }

 private:
  struct Finding {
    EffectId id;
    std::string effect;
    std::vector<ParameterValue> parameters;
    double heldout_before = 0.0, heldout_after = 0.0;
  };
  [[nodiscard]] static std::vector<Finding> findings(const ClosureResult& result);
  void update_in_all(const std::vector<Finding>& now);

  std::vector<EffectInForce> in_force_;
  std::vector<Finding> last_;     // of the previous report
  std::vector<EffectId> in_all_;  // effects found by every report
  bool has_reports_ = false, changes_delays_ = false;
};

}  // namespace core::closure
