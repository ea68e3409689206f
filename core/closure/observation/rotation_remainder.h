#pragma once

#include <Eigen/Core>

#include "core/closure/observation/frame_model.h"
#include "core/closure/observation/observation_record.h"

namespace core::closure {

// Turns of the camera act on the full projection; the model's fields are their first order at the mean places. This
// takes the difference out of `positions` (2 points x frames, undistorted, px): turned back exactly and moved on by the
// first order, constant part included, so that a turn's translation stays where the model has it.
// turns, rates: 3 x frames, rotation vector of the camera (rad, about x right, y down, z forward; a static ray r moves
// by turn x r) at the mean row's time and its change per frame. Beyond the second order nothing is kept.
void take_out_remainder(const ObservationRecord& record, const PointGeometry& mean, const Eigen::MatrixXd& turns,
                        const Eigen::MatrixXd& rates, double readout_frames, double mean_share,
                        Eigen::MatrixXd& positions);

}  // namespace core::closure
