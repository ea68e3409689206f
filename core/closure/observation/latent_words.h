#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"
#include "core/closure/observation/point_motion_model.h"

namespace core::closure {

// A known series that may correlate with the amplitude of a pattern.
struct KnownSignal {
  std::string name;
  Eigen::RowVectorXd series;
};

// Describes a pattern over the points (2 points long, px) with this amplitude over time: region and axis, smoothness
// over the image (share of its squares explained by a linear field, a quadratic one, or one per row), strongest
// frequency, and the known signal with which it correlates best.
[[nodiscard]] std::string latent_words(const Eigen::VectorXd& field, const Eigen::RowVectorXd& amplitude,
                                       const ObservationRecord& record, const PointGeometry& geometry,
                                       const std::vector<KnownSignal>& known);

}  // namespace core::closure
