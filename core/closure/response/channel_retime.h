#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/response/channel_predictor.h"

namespace core::closure {

// The record on an even grid of another time: sample k, of which the other time is `time_s(k)` (increasing), by the
// cubic through the four samples nearest to each new instant. No sample is made across a gap: a missing one, or more than 1.75 steps of the grid. The new record has the
// rate of the old one and as many samples as fit. Error of a cubic: below 1 % of an amplitude up to a fifth of the rate.
[[nodiscard]] ChannelRecord retimed(const ChannelRecord& record, const Eigen::VectorXd& time_s);

// The same for a record whose samples lie evenly in their own time, of which `time_s` is a smooth function: by a
// windowed sinc over 32 samples, exact to 1 % of an amplitude up to 0.42 of the rate; near gaps and ends by that cubic.
[[nodiscard]] ChannelRecord warped(const ChannelRecord& record, const Eigen::VectorXd& time_s);

// A time along which frequencies that are `factor(k)` times the wanted ones at sample k stay the wanted ones.
[[nodiscard]] Eigen::VectorXd time_of_factor(const Eigen::VectorXd& factor, double rate_hz);

}  // namespace core::closure
