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
  std::uint64_t from_sequence = 0;  // frame
};

// Decides from consecutive reports of the observation level which effects a run corrects in its own points. Reports are
// made of the points as measured, so a corrected effect is found again as long as the correction helps. Corrected are
// effects that can be (ObservationEffect::in_flight), once two consecutive reports name them with the same numbers and
// no rival. Withdrawn if a report made entirely of later frames does not find it. All others are reported but not
// corrected.
class Adoption {
 public:
  static constexpr double kSameSigmas = 5.0, kSameShare = 0.1;  // of two numbers for one quantity: either is enough

  // Descriptions of what changes by this report, from from_sequence on. Empty: nothing changes.
  [[nodiscard]] std::vector<std::string> update(const ClosureReport& report, std::uint64_t from_sequence);

  [[nodiscard]] const std::vector<EffectInForce>& in_force() const noexcept { return in_force_; }
  // "readout time: added readout = 0.56 +- 0.001 frames, from frame 3600 on".
  [[nodiscard]] std::vector<std::string> words() const;
  // Of all effects in force. camera: that of the record from which the reports are made.
  [[nodiscard]] RunCorrection correction(const CameraModel& camera) const;
  // The last update changed the row delays themselves, and not only their precision: an effect that changes them was
  // not in every report since the first.
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
