#include "core/closure/observation/residual_view.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/linear/dense.h"
#include "core/spectrum/real_fft.h"

namespace core::closure {
namespace {

constexpr int kMostSegment = 512;

void add_patterns(const Eigen::MatrixXd& residual_px, ResidualView& view) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram(residual_px));
  const auto n = static_cast<double>(residual_px.size()), frames = static_cast<double>(residual_px.cols());
  const Eigen::Index last = residual_px.rows() - 1;
  for (Eigen::Index i = last; i >= 0; --i)
    view.singular_px.push_back(std::sqrt(std::max(solver.eigenvalues()(i), 0.0) / n));
  const Eigen::VectorXd leading =
      solver.eigenvectors().col(last) * std::sqrt(std::max(solver.eigenvalues()(last), 0.0) / frames);
  view.pattern_px = Eigen::Map<const Eigen::MatrixXd>(leading.data(), 2, leading.size() / 2).transpose();
}

void add_spectrum(const Eigen::MatrixXd& residual_px, double rate_hz, ResidualView& view) {
  int length = 16;
  while (2 * length <= std::min<Eigen::Index>(kMostSegment, residual_px.cols())) length *= 2;
  RealFft fft(length);
  std::vector<double> window(static_cast<std::size_t>(length)), series = window;
  double squares = 0.0;
  for (int i = 0; i < length; ++i) {
    const double w = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / length);
    window[static_cast<std::size_t>(i)] = w, squares += w * w;
  }
  std::vector<std::complex<double>> bins(static_cast<std::size_t>(fft.n_bins()));
  std::vector<double> power(bins.size(), 0.0);
  double n = 0.0;
  for (Eigen::Index at = 0; at + length <= residual_px.cols(); at += length / 2) {
    for (Eigen::Index row = 0; row < residual_px.rows(); ++row, n += 1.0) {
      for (int i = 0; i < length; ++i)
        series[static_cast<std::size_t>(i)] = window[static_cast<std::size_t>(i)] * residual_px(row, at + i);
      fft.forward(series, bins);
      for (std::size_t b = 0; b < bins.size(); ++b) power[b] += std::norm(bins[b]);
    }
  }
  for (std::size_t b = 1; b + 1 < bins.size(); ++b) {
    view.frequency_hz.push_back(rate_hz * static_cast<double>(b) / length);
    view.level_px.push_back(std::sqrt(2.0 * power[b] / std::max(n, 1.0) / (rate_hz * squares)));
  }
}

}  // namespace

ResidualView residual_view(const Eigen::MatrixXd& residual_px, const Eigen::VectorXd& mean_px, double rate_hz) {
  ResidualView view;
  view.place_px = Eigen::Map<const Eigen::MatrixXd>(mean_px.data(), 2, mean_px.size() / 2).transpose();
  add_patterns(residual_px, view);
  add_spectrum(residual_px, rate_hz, view);
  return view;
}

}  // namespace core::closure
