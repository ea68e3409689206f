#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/response/channel_predictor.h"

namespace core::closure {

// Resamples a record to an even grid of another time: `time_s(k)` (increasing) is that time of sample k. Uses the cubic
// through the four samples nearest to each new instant. Gaps are not interpolated: missing samples, or more than 1.75
// steps of the grid. The new record has the rate of the old one and as many samples as fit. Error of a cubic: below 1 %
// of an amplitude up to a fifth of the rate.
[[nodiscard]] ChannelRecord retimed(const ChannelRecord& record, const Eigen::VectorXd& time_s);

// The same for a record whose samples are even in their own time, with `time_s` a smooth function of it: by a windowed
// sinc over 32 samples, exact to 1 % of an amplitude up to 0.42 of the rate; near gaps and ends by that cubic.
[[nodiscard]] ChannelRecord warped(const ChannelRecord& record, const Eigen::VectorXd& time_s);

// Time along which frequencies that are `factor(k)` times the reference ones at sample k become constant.
[[nodiscard]] Eigen::VectorXd time_of_factor(const Eigen::VectorXd& factor, double rate_hz);

}  // namespace core::closure
