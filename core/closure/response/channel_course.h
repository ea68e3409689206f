#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/response/channel_predictor.h"

namespace core::closure {

// Change of all frequencies along a course, relative and per unit of the course: the one that leaves no trace of the
// course in the record after retiming to constant frequencies (channel_retime.h). Estimated from poles below 0.36 of
// the rate only: above, a mode may be aliased, with an apparent frequency that falls while the true one rises.
struct CourseFit {
  double change = 0.0;
  std::vector<double> without;  // estimates that each leave out one part of the record, for the standard deviation
};
// `record`: channels relative to the input. `without` is empty if the record cannot be predicted.
[[nodiscard]] CourseFit fit_course(const ChannelRecord& record, Eigen::Index order, const Eigen::VectorXd& course);

}  // namespace core::closure
