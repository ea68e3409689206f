#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "core/closure/response/channel_predictor.h"

namespace core::closure {

// Number of time steps between two samples of a record, judged by the predictor: ln of the likelihood of another number
// of steps over that of one step. Later samples count as well: a gust, a shock or a mistracked frame is followed by
// samples that the unchanged order of samples predicts; a lost or inserted frame is not. Errors have the tails of a t
// distribution, so that one outlier is not decisive.
class StepLikelihood {
 public:
  // Both arguments must outlive the object.
  StepLikelihood(const ChannelRecord& scaled, const ChannelPredictor& predictor);

  [[nodiscard]] bool ok() const noexcept { return ok_; }

  struct Ratio {
    double own = 0.0;       // of sample k
    double after = 0.0;     // of the later samples whose prediction reaches back to the step
    bool possible = false;  // true if the changed number of steps explains the sample
  };
  // Two steps between samples k - 1 and k: one frame is missing before k.
  [[nodiscard]] Ratio frame_missing(Eigen::Index k) const;
  // Samples k - 1 and k show the same picture (a repeated frame), and k + 1 follows k - 1 by one step, not by two: the
  // frame was inserted and does not replace another.
  [[nodiscard]] double inserted(Eigen::Index k) const;

 private:
  // Rows of values and inputs in a modified order, oldest first.
  struct Window {
    std::vector<Eigen::RowVectorXd> value, input;
    void add(const ChannelRecord& scaled, Eigen::Index k);
  };
  [[nodiscard]] Eigen::VectorXd ahead(const Window& window) const;  // predicts its last row from the others
  [[nodiscard]] double log_one(const Eigen::VectorXd& error) const;
  [[nodiscard]] double log_two(const Eigen::VectorXd& error) const;
  [[nodiscard]] double log_tail(double squares) const;
  [[nodiscard]] bool seen(Eigen::Index first, Eigen::Index last) const;
  [[nodiscard]] Window until(Eigen::Index k) const;                                   // the samples that predict k
  void append_unseen(Window& window, Eigen::Index before, Eigen::Index after) const;  // missing row

  const ChannelRecord& scaled_;
  const ChannelPredictor& predictor_;
  Eigen::LLT<Eigen::MatrixXd> two_;
  double log_det_one_ = 0.0, log_det_two_ = 0.0;  // of the whiteners
  bool ok_ = false;
};

// Number of events from the logarithms of their likelihood ratios, one per sample. The probability p of an event at
// a sample follows from its ratio and from the share of samples with an event, which is estimated with it
// (expectation maximisation). count = sum of p; its variance is the sum of p (1 - p), enlarged by the uncertainty of
// the share.
struct EventCount {
  double count = 0.0, sigma = 0.0;
  double evidence = 0.0;              // ln of the likelihood with events over that without
  std::vector<std::size_t> likely{};  // samples with p above one half
};
[[nodiscard]] EventCount count_events(const std::vector<double>& log_ratios);

}  // namespace core::closure
