#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/response/channel_predictor.h"

namespace core::closure {

// Change of all frequencies along a course, relative and per unit of the course: that with which nothing of the course
// is left in the record once it is put on a time along which the frequencies stay (channel_retime.h). Sought by poles
// below 0.36 of the rate only: above, a mode may be a folded one, whose apparent frequency falls while the true one rises.
struct CourseFit {
  double change = 0.0;
  std::vector<double> without;  // without one part of the record each, for its standard deviation
};
// `record`: channels relative to the input. Empty `without` where the record cannot be predicted.
[[nodiscard]] CourseFit fit_course(const ChannelRecord& record, Eigen::Index order, const Eigen::VectorXd& course);

}  // namespace core::closure
