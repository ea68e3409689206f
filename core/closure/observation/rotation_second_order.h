#pragma once

#include <Eigen/Core>

#include "core/closure/observation/observation_record.h"
#include "core/closure/observation/point_motion_model.h"

namespace core::closure {

// A camera rotation acts on the full projection; the model's fields are its first order at the mean positions. This
// function removes the difference from `positions` (2 points x frames, undistorted, px): it rotates positions back
// exactly and adds the first order, constant part included, so that translation caused by rotation stays where the
// model expects it. rotations, rates: 3 x frames, rotation vector of the camera (rad, about x right, y down, z forward;
// a static ray r moves by rotation x r) at the time of the mean row, and its change per frame. Terms beyond second
// order are dropped.
void remove_second_order(const ObservationRecord& record, const PointGeometry& mean, const Eigen::MatrixXd& rotations,
                         const Eigen::MatrixXd& rates, double readout_frames, double mean_share,
                         Eigen::MatrixXd& positions);

}  // namespace core::closure
