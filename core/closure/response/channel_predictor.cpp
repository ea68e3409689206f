#include "core/closure/response/channel_predictor.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

constexpr double kFarOut = 6.0, kRidge = 1e-9;

bool seen(const MatrixXd& values, Index row) { return values.row(row).allFinite(); }

// Values minus the mean of the observed samples, in units of the standard deviation.
MatrixXd standardised(const MatrixXd& values, VectorXd& mean, VectorXd& deviation) {
  mean = VectorXd::Zero(values.cols());
  deviation = VectorXd::Ones(values.cols());
  MatrixXd out = values;
  for (Index c = 0; c < values.cols(); ++c) {
    double sum = 0.0, squares = 0.0, n = 0.0;
    for (const double v : values.col(c)) {
      if (std::isfinite(v)) sum += v, n += 1.0;
    }
    mean(c) = n > 0.0 ? sum / n : 0.0;
    for (const double v : values.col(c)) {
      if (std::isfinite(v)) squares += (v - mean(c)) * (v - mean(c));
    }
    deviation(c) = squares > 0.0 ? std::sqrt(squares / n) : 1.0;
    out.col(c) = (values.col(c).array() - mean(c)) / deviation(c);
  }
  return out;
}

class Fitter {
 public:
  Fitter(const ChannelRecord& scaled, ChannelPredictor& out) : record_(scaled), out_(out) {
    const Index n = record_.n_samples(), width = 1 + out.order * out.n_channels + (out.order + 1) * out.n_inputs;
    out.regressors = MatrixXd::Zero(n, width);
    out.usable.assign(static_cast<std::size_t>(n), 0);
    std::vector<char> whole_row(static_cast<std::size_t>(n), 0);
    for (Index k = 0; k < n; ++k)
      whole_row[static_cast<std::size_t>(k)] =
          seen(record_.value, k) && (out.n_inputs == 0 || seen(record_.input, k)) ? 1 : 0;
    for (Index k = out.order; k < n; ++k) {
      bool all = true;
      for (Index i = 0; i <= out.order; ++i) all = all && whole_row[static_cast<std::size_t>(k - i)] != 0;
      if (!all) continue;
      out.usable[static_cast<std::size_t>(k)] = 1;
      fill(k);
    }
    out.plain = out.usable;
  }

  bool run() {
    if (!solve()) return false;
    for (std::size_t k = 0; k < out_.plain.size(); ++k) {
      if (out_.usable[k] == 0) continue;
      const double square = (out_.whitener * out_.innovation.row(static_cast<Index>(k)).transpose()).squaredNorm();
      const double n = static_cast<double>(out_.n_channels);
      if (square > (n + kFarOut * std::sqrt(2.0 * n)) * typical_) out_.plain[k] = 0;
    }
    return solve();
  }

 private:
  void fill(Index k) {
    Index at = 0;
    out_.regressors(k, at++) = 1.0;
    for (Index i = 1; i <= out_.order; ++i, at += out_.n_channels)
      out_.regressors.row(k).segment(at, out_.n_channels) = record_.value.row(k - i);
    for (Index i = 0; i <= out_.order && out_.n_inputs > 0; ++i, at += out_.n_inputs)
      out_.regressors.row(k).segment(at, out_.n_inputs) = record_.input.row(k - i);
  }

  bool solve() {
    constexpr Index kParts = ChannelPredictor::kParts;
    const Index n = out_.regressors.rows(), width = out_.regressors.cols();
    std::vector<MatrixXd> gram(kParts, MatrixXd::Zero(width, width)),
        cross(kParts, MatrixXd::Zero(width, out_.n_channels));
    out_.innovation.setZero(n, out_.n_channels);
    for (Index part = 0; part < kParts; ++part) {
      std::vector<Index> mine;
      for (Index k = 0; k < n; ++k) {
        if (out_.plain[static_cast<std::size_t>(k)] != 0 && out_.part_of(k) == part) mine.push_back(k);
      }
      if (mine.empty()) continue;
      const MatrixXd z = out_.regressors(mine, Eigen::all), y = record_.value(mine, Eigen::all);
      gram[static_cast<std::size_t>(part)].noalias() = z.transpose() * z;
      cross[static_cast<std::size_t>(part)].noalias() = z.transpose() * y;
    }
    MatrixXd all_gram = MatrixXd::Zero(width, width), all_cross = MatrixXd::Zero(width, out_.n_channels);
    for (std::size_t p = 0; p < kParts; ++p) all_gram += gram[p], all_cross += cross[p];
    const double n_plain = all_gram(0, 0);
    if (n_plain < 3.0 * static_cast<double>(width)) return false;
    const VectorXd ridge = kRidge * all_gram.diagonal();
    out_.whole = solved(all_gram, ridge, all_cross);
    for (std::size_t p = 0; p < kParts; ++p) {
      const MatrixXd without = solved(all_gram - gram[p], ridge, all_cross - cross[p]);
      for (Index k = 0; k < n; ++k) {
        if (out_.usable[static_cast<std::size_t>(k)] == 0 || out_.part_of(k) != static_cast<Index>(p)) continue;
        out_.innovation.row(k) = record_.value.row(k) - out_.regressors.row(k) * without;
      }
    }
    return whiten(n_plain);
  }

  static MatrixXd solved(MatrixXd gram, const VectorXd& ridge, const MatrixXd& cross) {
    gram.diagonal() += ridge;
    return gram.ldlt().solve(cross);
  }

  bool whiten(double n_plain) {
    MatrixXd covariance = MatrixXd::Zero(out_.n_channels, out_.n_channels);
    for (std::size_t k = 0; k < out_.plain.size(); ++k) {
      if (out_.plain[k] == 0) continue;
      const RowVectorXd e = out_.innovation.row(static_cast<Index>(k));
      covariance.noalias() += e.transpose() * e / n_plain;
    }
    covariance.diagonal().array() += 1e-12 * (covariance.trace() + 1e-300);
    const Eigen::LLT<MatrixXd> factor(covariance);
    if (factor.info() != Eigen::Success || !covariance.allFinite()) return false;
    out_.whitener = factor.matrixL().solve(MatrixXd::Identity(out_.n_channels, out_.n_channels));
    // Outliers inflate the first covariance: the median row gives the size of a typical one.
    std::vector<double> squares;
    for (std::size_t k = 0; k < out_.usable.size(); ++k) {
      if (out_.usable[k] != 0)
        squares.push_back((out_.whitener * out_.innovation.row(static_cast<Index>(k)).transpose()).squaredNorm());
    }
    const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::nth_element(squares.begin(), middle, squares.end());
    const double n = static_cast<double>(out_.n_channels);
    typical_ = *middle / (n * std::pow(1.0 - 2.0 / (9.0 * n), 3));
    return typical_ > 0.0 && std::isfinite(typical_);
  }

  const ChannelRecord& record_;
  ChannelPredictor& out_;
  double typical_ = 1.0;
};

}  // namespace

Eigen::MatrixXd ChannelPredictor::lag(Index i) const {
  return whole.middleRows(1 + (i - 1) * n_channels, n_channels).transpose();
}

ChannelPredictor fit_predictor(const ChannelRecord& record, Index order, ChannelRecord& scaled) {
  ChannelPredictor out;
  out.order = order;
  out.n_channels = record.value.cols();
  out.n_inputs = record.input.cols();
  VectorXd input_mean, input_deviation;
  scaled.rate_hz = record.rate_hz;
  scaled.value = standardised(record.value, out.mean, out.deviation);
  scaled.input = standardised(record.input, input_mean, input_deviation);
  out.innovation.setZero(record.n_samples(), out.n_channels);
  if (record.n_samples() <= order) {
    out.usable.assign(static_cast<std::size_t>(record.n_samples()), 0);
    out.plain = out.usable;
    return out;
  }
  Fitter fitter(scaled, out);
  out.ok = fitter.run();
  return out;
}

VectorXd predict(const ChannelPredictor& predictor, const MatrixXd& history, const MatrixXd& input) {
  RowVectorXd row(predictor.whole.rows());
  Index at = 0;
  row(at++) = 1.0;
  for (Index i = 0; i < predictor.order; ++i, at += predictor.n_channels)
    row.segment(at, predictor.n_channels) = history.row(i);
  for (Index i = 0; i <= predictor.order && predictor.n_inputs > 0; ++i, at += predictor.n_inputs)
    row.segment(at, predictor.n_inputs) = input.row(i);
  return (row * predictor.whole).transpose();
}

}  // namespace core::closure
