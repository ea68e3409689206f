#include "core/closure/response/effects/step_likelihood.h"

#include <algorithm>
#include <cmath>

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

constexpr double kTails = 10.0;     // degrees of freedom of the errors' t distribution
constexpr double kExplained = 6.0;  // limit in standard deviations of chi-square
constexpr double kHopeless = -6.0;  // ln of a sample's own ratio which later samples cannot outweigh
constexpr int kRounds = 60;

}  // namespace

void StepLikelihood::Window::add(const ChannelRecord& scaled, Index k) {
  value.emplace_back(scaled.value.row(k));
  input.emplace_back(scaled.input.cols() > 0 ? RowVectorXd(scaled.input.row(k)) : RowVectorXd());
}

StepLikelihood::StepLikelihood(const ChannelRecord& scaled, const ChannelPredictor& predictor)
    : scaled_(scaled), predictor_(predictor) {
  const Index n = predictor_.n_channels;
  MatrixXd covariance = MatrixXd::Zero(n, n);
  double count = 0.0;
  for (Index k = predictor_.order; k + 1 < scaled_.n_samples(); ++k) {
    if (predictor_.plain[static_cast<std::size_t>(k)] == 0 || predictor_.plain[static_cast<std::size_t>(k + 1)] == 0)
      continue;
    // Predicts over sample k as if it were missing; its input is the mean of its neighbours', as for a lost sample.
    Window window = until(k);
    append_unseen(window, k - 1, k + 1);
    window.add(scaled_, k + 1);
    const VectorXd e = scaled_.value.row(k + 1).transpose() - ahead(window);
    covariance += e * e.transpose();
    count += 1.0;
  }
  covariance /= std::max(count, 1.0);
  covariance.diagonal().array() += 1e-12 * (covariance.trace() + 1e-300);
  two_.compute(covariance);
  ok_ = count > 10.0 * static_cast<double>(n) && two_.info() == Eigen::Success;
  if (!ok_) return;
  log_det_one_ = predictor_.whitener.diagonal().array().log().sum();
  log_det_two_ = -MatrixXd(two_.matrixL()).diagonal().array().log().sum();
}

bool StepLikelihood::seen(Index first, Index last) const {
  if (first < 0 || last >= scaled_.n_samples()) return false;
  for (Index k = first; k <= last; ++k) {
    if (!scaled_.value.row(k).allFinite()) return false;
    if (scaled_.input.cols() > 0 && !scaled_.input.row(k).allFinite()) return false;
  }
  return true;
}

StepLikelihood::Window StepLikelihood::until(Index k) const {
  Window out;
  for (Index i = predictor_.order; i > 0; --i) out.add(scaled_, k - i);
  return out;
}

VectorXd StepLikelihood::ahead(const Window& window) const {
  const std::size_t at = window.value.size() - 1;
  RowVectorXd row(predictor_.whole.rows());
  Index to = 0;
  row(to++) = 1.0;
  for (Index i = 1; i <= predictor_.order; ++i, to += predictor_.n_channels)
    row.segment(to, predictor_.n_channels) = window.value[at - static_cast<std::size_t>(i)];
  for (Index i = 0; i <= predictor_.order && predictor_.n_inputs > 0; ++i, to += predictor_.n_inputs)
    row.segment(to, predictor_.n_inputs) = window.input[at - static_cast<std::size_t>(i)];
  return (row * predictor_.whole).transpose();
}

double StepLikelihood::log_tail(double squares) const {
  const auto n = static_cast<double>(predictor_.n_channels);
  return -0.5 * (kTails + n) * std::log1p(squares / kTails);
}

double StepLikelihood::log_one(const VectorXd& error) const {
  return log_det_one_ + log_tail((predictor_.whitener * error).squaredNorm());
}

double StepLikelihood::log_two(const VectorXd& error) const {
  return log_det_two_ + log_tail(two_.matrixL().solve(error).squaredNorm());
}

void StepLikelihood::append_unseen(Window& window, Index before, Index after) const {
  window.input.push_back(scaled_.input.cols() > 0
                             ? RowVectorXd(0.5 * (scaled_.input.row(before) + scaled_.input.row(after)))
                             : RowVectorXd());
  window.value.emplace_back(RowVectorXd::Zero(predictor_.n_channels));
  window.value.back() = ahead(window).transpose();
}

StepLikelihood::Ratio StepLikelihood::frame_missing(Index k) const {
  Ratio out;
  const Index p = predictor_.order;
  if (!ok_ || !seen(k - p, k)) return out;
  Window one = until(k), two = one;
  append_unseen(two, k - 1, k);
  one.add(scaled_, k), two.add(scaled_, k);
  const VectorXd x = scaled_.value.row(k).transpose();
  const VectorXd e_two = x - ahead(two);
  const auto n = static_cast<double>(x.size());
  // Two steps must explain the sample: an outlier is explained by neither.
  out.possible = two_.matrixL().solve(e_two).squaredNorm() <= n + kExplained * std::sqrt(2.0 * n);
  out.own = log_two(e_two) - log_one(x - ahead(one));
  if (!out.possible || out.own < kHopeless) return out;
  for (Index j = k + 1; j < k + p && seen(j, j); ++j) {
    one.add(scaled_, j), two.add(scaled_, j);
    const VectorXd y = scaled_.value.row(j).transpose();
    out.after += log_one(y - ahead(two)) - log_one(y - ahead(one));
  }
  return out;
}

double StepLikelihood::inserted(Index k) const {
  const Index p = predictor_.order;
  if (!ok_ || k + 1 >= scaled_.n_samples() || !seen(k - p, k + 1)) return 0.0;
  // Samples up to k - 1, followed by k + 1: after one step, or after two.
  Window one = until(k), two = one;
  append_unseen(two, k - 1, k + 1);
  one.add(scaled_, k + 1), two.add(scaled_, k + 1);
  const VectorXd x = scaled_.value.row(k + 1).transpose();
  return log_one(x - ahead(one)) - log_two(x - ahead(two));
}

EventCount count_events(const std::vector<double>& log_ratios) {
  constexpr double kFirstShare = 0.01;
  EventCount out;
  const auto n = static_cast<double>(log_ratios.size());
  if (log_ratios.empty()) return out;
  double share = kFirstShare, variance = 0.0;
  const auto probability = [&](double log_ratio) {
    return 1.0 / (1.0 + (1.0 - share) / share * std::exp(-std::min(log_ratio, 500.0)));
  };
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0.0;
    for (const double ratio : log_ratios) sum += probability(ratio);
    share = std::clamp(sum / n, 1e-12, 0.5);
  }
  for (std::size_t i = 0; i < log_ratios.size(); ++i) {
    const double p = probability(log_ratios[i]);
    out.count += p, variance += p * (1.0 - p);
    if (p > 0.5) out.likely.push_back(i);
    out.evidence +=
        log_ratios[i] > 500.0 ? log_ratios[i] + std::log(share) : std::log1p(share * std::expm1(log_ratios[i]));
  }
  const double known = out.count > 0.0 ? std::max(1.0 - variance / out.count, 0.05) : 1.0;
  out.sigma = std::sqrt(variance / known);
  return out;
}

}  // namespace core::closure
