#include "core/closure/response/channel_jitter.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

// Central differences of sixth order; the samples ahead of k are predicted.
constexpr double kTap[3] = {3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0};
constexpr Index kAhead = 3;
constexpr int kGrid = 33;
constexpr double kLeast_s = 1e-4, kMostOfStep = 0.25, kLeastLeft = 0.05;

class Velocities {
 public:
  Velocities(const ChannelRecord& scaled, const ChannelPredictor& predictor) : scaled_(scaled), predictor_(predictor) {}

  // Whitened derivative of the innovation by a time error, per second; empty if it cannot be computed.
  [[nodiscard]] VectorXd at(Index k) const {
    const Index p = predictor_.order;
    if (k < std::max(p, kAhead) || k + kAhead >= scaled_.n_samples()) return {};
    for (Index i = -kAhead; i <= kAhead && predictor_.n_inputs > 0; ++i) {
      if (!scaled_.input.row(k + i).allFinite()) return {};
    }
    MatrixXd history(p, predictor_.n_channels), input(p + 1, predictor_.n_inputs);
    for (Index i = 0; i < p; ++i) history.row(i) = scaled_.value.row(k - 1 - i);
    RowVectorXd velocity = RowVectorXd::Zero(predictor_.n_channels);
    for (Index step = 0; step <= kAhead; ++step) {
      for (Index i = 0; i <= p && predictor_.n_inputs > 0; ++i) {
        if (k + step < i) return {};
        input.row(i) = scaled_.input.row(k + step - i);
      }
      const RowVectorXd next = predict(predictor_, history, input).transpose();
      if (step > 0) velocity += kTap[step - 1] * (next - scaled_.value.row(k - step));
      for (Index i = p - 1; i > 0; --i) history.row(i) = history.row(i - 1).eval();
      history.row(0) = next;
    }
    if (predictor_.n_inputs > 0) {
      RowVectorXd input_velocity = RowVectorXd::Zero(predictor_.n_inputs);
      for (Index step = 1; step <= kAhead; ++step)
        input_velocity += kTap[step - 1] * (scaled_.input.row(k + step) - scaled_.input.row(k - step));
      const Index first = 1 + predictor_.order * predictor_.n_channels;
      velocity -= input_velocity * predictor_.whole.middleRows(first, predictor_.n_inputs);
    }
    if (!velocity.allFinite()) return {};
    return scaled_.rate_hz * (predictor_.whitener * velocity.transpose());
  }

 private:
  const ChannelRecord& scaled_;
  const ChannelPredictor& predictor_;
};

struct Rows {
  std::vector<Index> sample;
  std::vector<VectorXd> velocity;
};

// -2 ln likelihood of each row for one sigma; infinite if the jitter's share exceeds the mean covariance.
VectorXd squares_at(double sigma_s, const Rows& rows, const MatrixXd& whitened, const MatrixXd& mean_outer) {
  const Index n = whitened.cols();
  const double variance = sigma_s * sigma_s;
  const MatrixXd left = MatrixXd::Identity(n, n) - variance * mean_outer;
  VectorXd out = VectorXd::Constant(static_cast<Index>(rows.sample.size()), std::numeric_limits<double>::infinity());
  if (Eigen::SelfAdjointEigenSolver<MatrixXd>(left, Eigen::EigenvaluesOnly).eigenvalues()(0) < kLeastLeft) return out;
  const Eigen::LLT<MatrixXd> factor(left);
  const MatrixXd lower = factor.matrixL();
  const double log_det = 2.0 * lower.diagonal().array().log().sum();
  for (std::size_t i = 0; i < rows.sample.size(); ++i) {
    const VectorXd e = factor.matrixL().solve(whitened.row(rows.sample[i]).transpose());
    const VectorXd v = factor.matrixL().solve(rows.velocity[i]);
    const double along = v.dot(e), size = 1.0 + variance * v.squaredNorm();
    out(static_cast<Index>(i)) = e.squaredNorm() - variance * along * along / size + std::log(size) + log_det;
  }
  return out;
}

// Vertex of the parabola through the best grid value and its neighbours, over ln sigma; 0 if no value is best.
double sigma_at_top(const std::vector<double>& grid, const VectorXd& gain, Index best) {
  if (best == 0) return 0.0;
  const auto at = static_cast<std::size_t>(best);
  if (best == 1 || at + 1 >= grid.size()) return grid[at];
  const double low = gain(best - 1), top = gain(best), high = gain(best + 1), bend = low - 2.0 * top + high;
  const double shift = bend < 0.0 ? std::clamp(0.5 * (low - high) / bend, -0.5, 0.5) : 0.0;
  return grid[at] * std::pow(grid[at] / grid[at - 1], shift);
}

}  // namespace

JitterFit fit_jitter(const ChannelRecord& scaled, const ChannelPredictor& predictor, const MatrixXd& whitened) {
  JitterFit out;
  out.squares = whitened.rowwise().squaredNorm();
  const Velocities velocities(scaled, predictor);
  Rows rows;
  MatrixXd mean_outer = MatrixXd::Zero(whitened.cols(), whitened.cols());
  double n_plain = 0.0;
  for (Index k = 0; k < whitened.rows(); ++k) {
    if (predictor.usable[static_cast<std::size_t>(k)] == 0) continue;
    VectorXd velocity = velocities.at(k);
    if (velocity.size() == 0) continue;
    if (predictor.plain[static_cast<std::size_t>(k)] != 0)
      mean_outer += velocity * velocity.transpose(), n_plain += 1.0;
    rows.sample.push_back(k);
    rows.velocity.push_back(std::move(velocity));
  }
  if (n_plain < 100.0) return out;
  mean_outer /= n_plain;
  constexpr Index kParts = ChannelPredictor::kParts;
  const double ratio = std::pow(kMostOfStep / scaled.rate_hz / kLeast_s, 1.0 / (kGrid - 1));
  VectorXd plain_squares(static_cast<Index>(rows.sample.size()));
  for (std::size_t i = 0; i < rows.sample.size(); ++i)
    plain_squares(static_cast<Index>(i)) = out.squares(rows.sample[i]);
  // Decrease of the sum per sigma (first row: no jitter), without each part and over all parts.
  MatrixXd gain = MatrixXd::Zero(kGrid + 1, kParts + 1);
  std::vector<VectorXd> squares_of{plain_squares};
  std::vector<double> grid{kLeast_s / ratio};
  for (int g = 0; g < kGrid; ++g) {
    const double candidate = grid.back() * ratio;
    const VectorXd squares = squares_at(candidate, rows, whitened, mean_outer);
    if (!std::isfinite(squares(0))) break;
    for (std::size_t i = 0; i < rows.sample.size(); ++i) {
      if (predictor.plain[static_cast<std::size_t>(rows.sample[i])] == 0) continue;
      const double drop = plain_squares(static_cast<Index>(i)) - squares(static_cast<Index>(i));
      gain.row(g + 1).array() += drop;
      gain(g + 1, predictor.part_of(rows.sample[i])) -= drop;
    }
    squares_of.push_back(squares);
    grid.push_back(candidate);
  }
  std::vector<Index> best(static_cast<std::size_t>(kParts) + 1);
  for (Index part = 0; part <= kParts; ++part) {
    const auto n_tried = static_cast<Index>(grid.size());
    gain.col(part).head(n_tried).maxCoeff(&best[static_cast<std::size_t>(part)]);
    const double sigma_s = sigma_at_top(grid, gain.col(part).head(n_tried), best[static_cast<std::size_t>(part)]);
    if (part < kParts) {
      out.sigma_without_s.push_back(sigma_s);
    } else {
      out.sigma_s = sigma_s;
    }
  }
  for (std::size_t i = 0; i < rows.sample.size(); ++i) {
    const auto part = static_cast<std::size_t>(predictor.part_of(rows.sample[i]));
    out.squares(rows.sample[i]) = squares_of[static_cast<std::size_t>(best[part])](static_cast<Index>(i));
  }
  return out;
}

}  // namespace core::closure
