// FreeDecayFit: initial values.
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/closure/response/free_decay_fit.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Complex = FreeDecayFit::Complex;

constexpr int kFrequencies = 120, kPhases = 16;

// Residual of `data` after a fit of a constant and a decaying sine of any amplitude and phase per channel.
struct SineFit {
  double squares = 0.0;
  Eigen::VectorXcd amplitude;  // per channel
};

SineFit fit_sine(const MatrixXd& data, double frequency_hz, double rate_per_s, double sample_hz) {
  MatrixXd columns(data.rows(), 3);
  for (Index k = 0; k < data.rows(); ++k) {
    const double t = static_cast<double>(k) / sample_hz, a = std::exp(-rate_per_s * t);
    columns.row(k) << 1.0, a * std::cos(kTwoPi * frequency_hz * t), -a * std::sin(kTwoPi * frequency_hz * t);
  }
  const MatrixXd solution = columns.colPivHouseholderQr().solve(data);
  SineFit out;
  out.squares = (data - columns * solution).squaredNorm();
  out.amplitude = solution.row(1).transpose().cast<Complex>() + Complex(0, 1) * solution.row(2).transpose();
  return out;
}

struct ModeStart {
  double log_rate = 0.0, frequency_hz = 0.0, squares = std::numeric_limits<double>::infinity();
  MatrixXcd amplitude;  // channels x releases
};

// Best initial value of a grid, over all releases.
ModeStart search_mode(const std::vector<MatrixXd>& data, double sample_hz) {
  ModeStart best;
  for (int i = 1; i < kFrequencies; ++i) {
    const double hz = 0.5 * sample_hz * i / kFrequencies;
    for (const double rate : {0.5, 1.5, 4.0, 8.0}) {
      double squares = 0.0;
      for (const MatrixXd& decay : data) squares += fit_sine(decay, hz, rate * sample_hz / 25.0, sample_hz).squares;
      if (squares < best.squares) best = {std::log(rate * sample_hz / 25.0), hz, squares, {}};
    }
  }
  best.amplitude.resize(data.front().cols(), static_cast<Index>(data.size()));
  for (std::size_t r = 0; r < data.size(); ++r)
    best.amplitude.col(static_cast<Index>(r)) =
        fit_sine(data[r], best.frequency_hz, std::exp(best.log_rate), sample_hz).amplitude;
  return best;
}

// Converts the shape common to all releases (reference component 1) to a parameter vector.
Eigen::VectorXcd common_shape(const MatrixXcd& amplitude, Index reference) {
  const Eigen::JacobiSVD<MatrixXcd> svd(amplitude, Eigen::ComputeThinU);
  Eigen::VectorXcd shape = svd.matrixU().col(0);
  return std::abs(shape(reference)) > 1e-6 ? (shape / shape(reference)).eval() : Eigen::VectorXcd::Ones(shape.size());
}

void put_mode(const ModeStart& mode, Index reference, Index at, VectorXd& common) {
  common(at) = mode.log_rate;
  common(at + 1) = mode.frequency_hz;
  const Eigen::VectorXcd shape = common_shape(mode.amplitude, reference);
  at += 2;
  for (Index c = 0; c < shape.size(); ++c) {
    if (c == reference) continue;
    common(at) = shape(c).real(), common(at + 1) = shape(c).imag();
    at += 2;
  }
}

}  // namespace

FreeDecayFit::State FreeDecayFit::linear_start() const {
  const ModeStart mode = search_mode(decays_.release, decays_.rate_hz);
  State out;
  out.common = VectorXd::Zero(n_common());
  put_mode(mode, reference_, 0, out.common);
  for (Index r = 0; r < mode.amplitude.cols(); ++r) {
    const Complex a = mode.amplitude(reference_, r);
    out.own.push_back(Eigen::Vector2d(std::log(std::max(std::abs(a), 1e-9)), std::arg(a)));
  }
  return out;
}

// A changed rate shifts the phase by whole cycles: the best of several is used.
void FreeDecayFit::set_own_by_grid(State& state, std::size_t release) const {
  const VectorXd before = state.own[release];
  double best = std::numeric_limits<double>::infinity();
  VectorXd kept = before;
  for (const double amplitude : {-0.35, 0.0, 0.35, 0.7}) {
    for (int i = 0; i < kPhases; ++i) {
      state.own[release] = before;
      state.own[release](0) += amplitude;
      state.own[release](1) += kTwoPi * i / kPhases;
      const double squares = residual(state, release).squaredNorm();
      if (squares < best) best = squares, kept = state.own[release];
    }
  }
  state.own[release] = kept;
}

std::vector<FreeDecayFit::State> FreeDecayFit::starts_from(const State& before) const {
  State widened = before;
  const DecayEffect& last = *effects_.back();
  const auto n_new = static_cast<Index>(last.n_parameters());
  const Index n_further = n_common() - further_at(), kept = further_at() - n_new;
  widened.common = VectorXd::Zero(n_common());
  widened.common.head(kept) = before.common.head(kept);
  if (!last.adds_mode()) widened.common.tail(n_further) = before.common.tail(n_further);
  std::vector<State> out{widened};
  if (last.adds_mode()) {
    const FreeDecayFit plain(decays_, {effects_.begin(), effects_.end() - 1});
    std::vector<MatrixXd> left;
    for (std::size_t r = 0; r < decays_.release.size(); ++r) left.push_back(plain.residual(before, r));
    const ModeStart mode = search_mode(left, decays_.rate_hz);
    put_mode(mode, reference_, further_at(), out.front().common);
    for (std::size_t r = 0; r < left.size(); ++r) {
      VectorXd& own = out.front().own[r];
      const Complex a = mode.amplitude(reference_, static_cast<Index>(r));
      own.conservativeResize(4);
      own(2) = a.real(), own(3) = a.imag();
    }
  } else if (n_new > 0) {
    for (const double sign : {-1.0, 1.0}) {
      State started = widened;
      started.common(kept) = sign * last.start();
      for (std::size_t r = 0; r < started.own.size(); ++r) set_own_by_grid(started, r);
      out.push_back(std::move(started));
    }
  }
  return out;
}

}  // namespace core::closure
