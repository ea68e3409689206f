#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/closure/observation/frame_model.h"
#include "core/closure/observation/observation_record.h"

namespace core::closure {

// A series that a pattern's amplitude may go with.
struct KnownSignal {
  std::string name;
  Eigen::RowVectorXd series;
};

// What a pattern over the points (2 points long, px) with this amplitude over time looks like: which region and axis,
// how smooth it is over the image (share of its squares that a plane field, a quadratic one, or one per row holds), its
// strongest frequency, and the known signal that it goes with best.
[[nodiscard]] std::string latent_words(const Eigen::VectorXd& field, const Eigen::RowVectorXd& amplitude,
                                       const ObservationRecord& record, const PointGeometry& geometry,
                                       const std::vector<KnownSignal>& known);

}  // namespace core::closure
