#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/closure/response/effects/catalogue.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// By which two steps must be likelier than one, beside the logarithm of the number of samples: by chance a ratio above
// c has a probability below 1 / c, so a record without drops shows one with a probability below exp(-6).
constexpr double kLogLikelihood = 6.0;
constexpr double kExplained = 6.0;  // deviations of chi-square
constexpr Index kCluster = 6;       // samples that one drop disturbs

// Two steps ahead, the input of the lost sample taken halfway between its neighbours.
class TwoSteps {
 public:
  explicit TwoSteps(const ChannelContext& context) : scaled_(context.scaled), predictor_(context.predictor) {
    const Index n = predictor_.n_channels;
    MatrixXd covariance = MatrixXd::Zero(n, n);
    double count = 0.0;
    for (Index k = predictor_.order; k + 1 < scaled_.n_samples(); ++k) {
      if (!plain(k) || !plain(k + 1)) continue;
      const VectorXd e = scaled_.value.row(k + 1).transpose() - ahead(k, scaled_.input.cols() > 0 ? k + 1 : k);
      covariance += e * e.transpose();
      count += 1.0;
    }
    covariance /= std::max(count, 1.0);
    covariance.diagonal().array() += 1e-12 * (covariance.trace() + 1e-300);
    factor_.compute(covariance);
    ok_ = count > 10.0 * static_cast<double>(n) && factor_.info() == Eigen::Success;
  }

  // ln of how much likelier sample k is two steps after the one before it than one.
  [[nodiscard]] double log_ratio(Index k) const {
    if (!ok_) return 0.0;
    const VectorXd one = predictor_.whitener * predictor_.innovation.row(k).transpose();
    const VectorXd e = scaled_.value.row(k).transpose() - ahead(k, k);
    const MatrixXd lower = factor_.matrixL();
    const VectorXd two = factor_.matrixL().solve(e);
    // Two steps must explain the sample: where it is merely wild, neither does.
    const auto n = static_cast<double>(e.size());
    if (two.squaredNorm() > n + kExplained * std::sqrt(2.0 * n)) return 0.0;
    const double log_one = predictor_.whitener.diagonal().array().log().sum() - 0.5 * one.squaredNorm();
    return -lower.diagonal().array().log().sum() - 0.5 * two.squaredNorm() - log_one;
  }

 private:
  [[nodiscard]] bool plain(Index k) const { return predictor_.plain[static_cast<std::size_t>(k)] != 0; }

  // The state after sample k - 1, two steps on; `arrival`: where the input of the second step is read.
  [[nodiscard]] VectorXd ahead(Index k, Index arrival) const {
    const Index p = predictor_.order;
    MatrixXd history(p, predictor_.n_channels), input(p + 1, predictor_.n_inputs);
    for (Index i = 0; i < p; ++i) history.row(i) = scaled_.value.row(k - 1 - i);
    if (predictor_.n_inputs > 0) {
      for (Index i = 1; i <= p; ++i) input.row(i) = scaled_.input.row(k - i);
      input.row(0) = 0.5 * (scaled_.input.row(k - 1) + scaled_.input.row(arrival));
    }
    const VectorXd first = predict(predictor_, history, input);
    for (Index i = p - 1; i > 0; --i) history.row(i) = history.row(i - 1).eval();
    history.row(0) = first.transpose();
    if (predictor_.n_inputs > 0) {
      for (Index i = p; i > 0; --i) input.row(i) = input.row(i - 1).eval();
      input.row(0) = scaled_.input.row(arrival);
    }
    return predict(predictor_, history, input);
  }

  const ChannelRecord& scaled_;
  const ChannelPredictor& predictor_;
  Eigen::LLT<MatrixXd> factor_;
  bool ok_ = false;
};

// Frames that nobody counted are missing: the structure has gone on for two steps between two samples.
class DroppedFrames final : public ChannelEffect {
 public:
  [[nodiscard]] std::string name() const override { return "dropped_frames"; }
  [[nodiscard]] bool corrects() const override { return true; }
  [[nodiscard]] Corrected corrected(const ChannelContext& context) const override {
    std::vector<Index> before;
    const TwoSteps two(context);
    double best = 0.0;
    Index at = -1;
    const auto settle = [&] {
      if (at >= 0) before.push_back(at);
      at = -1, best = 0.0;
    };
    Index opened = 0;
    bool occur = false;
    for (Index k = context.predictor.order; k < context.record.n_samples(); ++k) {
      if (at >= 0 && k - opened >= kCluster) settle();
      if (context.predictor.usable[static_cast<std::size_t>(k)] == 0) continue;
      const double ratio = two.log_ratio(k);
      if (!(ratio > kLogLikelihood)) continue;
      occur = occur || ratio > kLogLikelihood + std::log(static_cast<double>(context.record.n_samples()));
      if (at < 0) opened = k;
      if (ratio > best) best = ratio, at = k;
    }
    settle();
    if (!occur) before.clear();
    return {with_gaps(context.record, before), before.size()};
  }
  [[nodiscard]] ParameterValue describe(double value) const override { return {"drops", "frames", value, {}}; }

 private:
  static ChannelRecord with_gaps(const ChannelRecord& record, const std::vector<Index>& before) {
    ChannelRecord out;
    out.rate_hz = record.rate_hz;
    const Index n = record.n_samples() + static_cast<Index>(before.size());
    out.value.setConstant(n, record.value.cols(), std::numeric_limits<double>::quiet_NaN());
    out.input.setConstant(n, record.input.cols(), std::numeric_limits<double>::quiet_NaN());
    std::size_t next = 0;
    for (Index k = 0, to = 0; k < record.n_samples(); ++k, ++to) {
      if (next < before.size() && before[next] == k) ++next, ++to;
      out.value.row(to) = record.value.row(k);
      out.input.row(to) = record.input.row(k);
    }
    return out;
  }
};

}  // namespace

std::unique_ptr<ChannelEffect> make_dropped_frames() { return std::make_unique<DroppedFrames>(); }

}  // namespace core::closure
