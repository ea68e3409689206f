#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/response/channel_predictor.h"

namespace core::closure {

// Sample times with jitter of standard deviation sigma: the innovation's covariance is C + sigma^2 v v^T, with v the
// velocity predicted from the previous samples (the sample itself contains the error). C is the mean covariance minus
// the jitter's mean share. All quantities are whitened.
struct JitterFit {
  double sigma_s = 0.0;
  std::vector<double> sigma_without_s;  // estimates that each leave out one part, for the standard deviation
  Eigen::VectorXd squares;              // per sample, held out: -2 ln likelihood; equal to |whitened|^2 for sigma = 0
};

// `whitened`: samples x channels, the innovations times the whitener.
[[nodiscard]] JitterFit fit_jitter(const ChannelRecord& scaled, const ChannelPredictor& predictor,
                                   const Eigen::MatrixXd& whitened);

}  // namespace core::closure
