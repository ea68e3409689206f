#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/place_correction.h"
#include "core/types/closure_report.h"

namespace core::closure {

// An effect that a run takes out of its own points.
struct EffectInForce {
  std::string effect;
  std::vector<ParameterValue> parameters;
  std::uint64_t from_sequence = 0;  // frame
};

// Which effects a run takes out of its own points, from one report of the observation level to the next. The reports
// are made of the points as they were measured: an effect in force is found again in each for as long as it helps.
// Taken out is what constants hold (readout time, lens, pixel locking), once two reports in a row name it with the same
// numbers and nothing could stand in its place. Withdrawn is what a report does not find although all its frames came
// after the adoption. What is neither named nor constant is told and left alone.
class Adoption {
 public:
  static constexpr double kSameSigmas = 5.0, kSameShare = 0.1;  // of two numbers for one quantity: either is enough

  // In words, what changes by this report; it counts from from_sequence on. Empty: nothing.
  [[nodiscard]] std::vector<std::string> update(const ClosureReport& report, std::uint64_t from_sequence);

  [[nodiscard]] const std::vector<EffectInForce>& in_force() const noexcept { return in_force_; }
  // "readout time: added readout = 0.56 +- 0.001 frames, from frame 3600 on".
  [[nodiscard]] std::vector<std::string> words() const;
  // camera: of the record that the reports are made of; its focal length and centre are those of the lens effects.
  [[nodiscard]] PlaceCorrection places(const CameraModel& camera) const;
  // The last update changed when rows are seen, and not only what is known of it: the readout time was not in every
  // report since the first.
  [[nodiscard]] bool changes_delays() const noexcept { return changes_delays_; }
  // Beyond the declared readout time, in frames, with its standard deviation; 0 of none.
  [[nodiscard]] ParameterValue added_readout() const;

 private:
  struct Finding {
    std::string effect;
    std::vector<ParameterValue> parameters;
    double heldout_before = 0.0, heldout_after = 0.0;
  };
  [[nodiscard]] static std::vector<Finding> findings(const ClosureResult& result);
  [[nodiscard]] double value(const std::string& effect, std::size_t parameter) const noexcept;

  std::vector<EffectInForce> in_force_;
  std::vector<Finding> last_;  // of the report before
  bool has_reports_ = false, readout_in_all_ = false, changes_delays_ = false;
};

}  // namespace core::closure
