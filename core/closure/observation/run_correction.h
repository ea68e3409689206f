#pragma once

#include <vector>

#include "core/geometry/point_correction.h"
#include "core/types/closure_result.h"

namespace core::closure {

// Corrections that a run applies to its own measurement, in addition to the declared values.
struct RunCorrection {
  PointCorrection places;
  ParameterValue added_readout;  // frames; value 0: as declared
};

// Interface of an effect that a run can correct in flight.
class InFlightCorrection {
 public:
  InFlightCorrection() = default;
  InFlightCorrection(const InFlightCorrection&) = delete;
  InFlightCorrection& operator=(const InFlightCorrection&) = delete;
  virtual ~InFlightCorrection() = default;

  // parameters: as reported. camera: the camera of the record from which the reports are computed.
  virtual void add_to(RunCorrection& correction, const std::vector<ParameterValue>& parameters,
                      const CameraModel& camera) const = 0;
  // True if the correction changes the times at which channels are seen: spectra of before and after must not be
  // summed.
  [[nodiscard]] virtual bool changes_row_delays() const { return false; }
};

}  // namespace core::closure
