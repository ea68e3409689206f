#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace core::closure {

// Channels on a uniform grid. Sample k of a channel is seen at k / rate_hz + its delay.
struct ChannelRecord {
  double rate_hz = 0.0;
  Eigen::MatrixXd value;                                 // samples x channels; a row with NaN is missing
  Eigen::MatrixXd input;                                 // samples x inputs (measured base); may have no columns
  std::vector<double> delay_s = {}, input_delay_s = {};  // row delays, per column; empty: 0
  bool input_alike = false;                              // the first input has the quantity and unit of the channels
  bool rate_is_average = false;  // rate_hz is samples / duration: a change of samples keeps the duration
  bool times_known = false;      // lost and late frames are known from time stamps: none remain to be detected
  [[nodiscard]] Eigen::Index n_samples() const noexcept { return value.rows(); }
};

// Motion of the channels relative to the first input, if that has the same quantity; else the channels unchanged. The
// input is interpolated to each channel's own instants. Motion that camera and ground cause in all channels alike is
// not structural: without this step a change of the structure's frequencies would be estimated from the camera's drift.
[[nodiscard]] ChannelRecord relative_to_input(const ChannelRecord& record);

// Linear prediction of every sample from the `order` samples before it and the measured input up to its own time: a
// linear structure under white forces (a vector autoregression with input, Ljung, System Identification, 4.2).
// Innovations are held out: each of ten contiguous parts is predicted by a fit to the other nine. Rows with an outlying
// innovation (more than 6 standard deviations of chi-square) are excluded from the fits, but all rows are scored.
struct ChannelPredictor {
  static constexpr Eigen::Index kParts = 10;

  Eigen::Index order = 0, n_channels = 0, n_inputs = 0;
  Eigen::MatrixXd whole;            // regressors x channels, fitted to all parts
  Eigen::MatrixXd regressors;       // samples x regressors; rows of unusable samples are 0
  Eigen::MatrixXd innovation;       // samples x channels, held out
  std::vector<char> usable;         // per sample: it and all samples that predict it were observed
  std::vector<char> plain;          // ... and its innovation is not an outlier
  Eigen::MatrixXd whitener;         // L^-1 of the innovations' covariance S = L L^T over the plain rows
  Eigen::VectorXd mean, deviation;  // of the channels, removed before the fit
  bool ok = false;

  [[nodiscard]] Eigen::Index part_of(Eigen::Index sample) const noexcept {
    return std::min(sample * kParts / std::max<Eigen::Index>(innovation.rows(), 1), kParts - 1);
  }
  // Coefficients of lag 1 .. order, channels x channels: x[k] = sum A_i x[k - i] + ...
  [[nodiscard]] Eigen::MatrixXd lag(Eigen::Index i) const;
};

// `scaled`: filled with the record as used by the predictor (mean removed, unit deviation; inputs likewise).
[[nodiscard]] ChannelPredictor fit_predictor(const ChannelRecord& record, Eigen::Index order, ChannelRecord& scaled);

// One-step prediction from `history` (row 0 the newest) and the inputs at the step and before (row 0 at the step).
[[nodiscard]] Eigen::VectorXd predict(const ChannelPredictor& predictor, const Eigen::MatrixXd& history,
                                      const Eigen::MatrixXd& input);

// Change of the prediction if all frequencies of lightly damped poles below 0.36 of the rate increase by the same small
// share: derivative of the lag coefficients, channels x (order * channels), newest lag first. Higher poles may be
// aliased, with falling apparent frequency. Empty if there is no such pole.
[[nodiscard]] Eigen::MatrixXd frequency_derivative(const ChannelPredictor& predictor, double rate_hz);

}  // namespace core::closure
