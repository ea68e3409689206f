#pragma once

#include <vector>

#include "core/geometry/point_correction.h"
#include "core/types/closure_result.h"

namespace core::closure {

// What a run corrects in its own measurement, beyond what was declared.
struct RunCorrection {
  PointCorrection places;
  ParameterValue added_readout;  // frames; value 0: as declared
};

// How a run corrects an effect in flight: the effect's own answer.
class InFlightCorrection {
 public:
  InFlightCorrection() = default;
  InFlightCorrection(const InFlightCorrection&) = delete;
  InFlightCorrection& operator=(const InFlightCorrection&) = delete;
  virtual ~InFlightCorrection() = default;

  // parameters: as reported. camera: that of the record from which the reports are made.
  virtual void add_to(RunCorrection& correction, const std::vector<ParameterValue>& parameters,
                      const CameraModel& camera) const = 0;
  // Channels are seen at other times than without it: spectra of before and after are not to be added.
  [[nodiscard]] virtual bool changes_row_delays() const { return false; }
};

}  // namespace core::closure
