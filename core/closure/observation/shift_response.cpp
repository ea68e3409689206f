#include "core/closure/observation/shift_response.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/types/constants.h"

namespace core::closure {
namespace {

using Eigen::Index;

constexpr std::array kEdges_hz{0.0, 0.25, 0.5, 1.0, 2.0, 4.0};  // a hovering camera moves below
constexpr double kFirstBins = 3.0;                              // of the window's main lobe: drift over the record
constexpr double kSlowest_hz = 0.05, kFastest_hz = 5.0;         // corners that are tried
constexpr int kCorners = 16;
constexpr int kLags = 10;
constexpr double kLagStep_s = 0.02;
constexpr std::array kGains{0.0, 0.35, 0.7};  // from which the search starts
constexpr double kMostGain = 0.95;
constexpr double kLeastApart = 0.05;  // 1 less the ratio of the depths
constexpr int kWeighings = 3, kSteps = 3;

std::vector<ShiftRegression::Band> bands_of(const TaperedSpectra& spectra) {
  std::vector<ShiftRegression::Band> out;
  const auto least = static_cast<Index>(std::ceil(kFirstBins / spectra.independent));
  for (std::size_t b = 0; b + 1 < kEdges_hz.size(); ++b) {
    const Index first = std::max(spectra.bin_of(kEdges_hz[b]), least), last = spectra.bin_of(kEdges_hz[b + 1]) - 1;
    if (last > first) out.push_back({first, last});
  }
  return out;
}

// work(first bin among those in use, number) for each band.
template <class Work>
void for_bands(const std::vector<ShiftRegression::Band>& bands, Work work) {
  Index at = 0;
  for (const ShiftRegression::Band& band : bands) {
    const Index n = band.last - band.first + 1;
    work(at, n);
    at += n;
  }
}

}  // namespace

std::complex<double> ShiftResponse::form(double hz) const {
  return std::complex<double>(0.0, hz) / std::complex<double>(corner_hz, hz) * std::polar(1.0, -kTwoPi * hz * lag_s);
}

ShiftRegression::ShiftRegression(const TaperedSpectra& spectra) : spectra_(spectra), bands_(bands_of(spectra)) {
  for (const Band& band : bands_) {
    for (Index b = band.first; b <= band.last; ++b) bins_.push_back(b);
  }
  weight_ = Eigen::VectorXd::Ones(size());
  moved_ = spectra.bins.row(0)(bins_).transpose();
  causes_ = spectra.bins.bottomRows(spectra.bins.rows() - 1)(Eigen::all, bins_).transpose();
  for (int round = 0; round < kWeighings; ++round) weigh(left_without());
  before_ = left_without();
}

ShiftRegression::Solution ShiftRegression::solve(const Eigen::MatrixXcd& added) const {
  Eigen::MatrixXcd columns(size(), causes_.cols() + added.cols());
  columns << causes_, added;
  const Eigen::VectorXd scale = columns.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXcd scaled = columns * scale.cast<std::complex<double>>().asDiagonal();
  const Eigen::MatrixXcd weighted = weight_.cast<std::complex<double>>().asDiagonal() * scaled;
  const Eigen::LDLT<Eigen::MatrixXd> solver((scaled.adjoint() * weighted).real());
  Solution out;
  out.values = scale.asDiagonal() * solver.solve((weighted.adjoint() * moved_).real());
  out.covariance = scale.asDiagonal() * solver.solve(Eigen::MatrixXd(scale.asDiagonal())) /
                   (2.0 * kOfHannWindow * spectra_.independent);
  out.left = moved_ - columns * out.values.cast<std::complex<double>>();
  return out;
}

Eigen::VectorXcd ShiftRegression::left_by_any() const {
  Eigen::MatrixXcd added = Eigen::MatrixXcd::Zero(size(), 2 * static_cast<Index>(bands_.size()));
  Index column = 0;
  for_bands(bands_, [&](Index at, Index n) {
    added.col(column++).segment(at, n) = causes_.col(0).segment(at, n);
    added.col(column++).segment(at, n) = std::complex<double>(0.0, 1.0) * causes_.col(0).segment(at, n);
  });
  return solve(added).left;
}

void ShiftRegression::weigh(const Eigen::VectorXcd& left) {
  for_bands(bands_, [&](Index at, Index n) {
    weight_.segment(at, n).setConstant(1.0 / std::max(left.segment(at, n).cwiseAbs2().mean(), 1e-300));
  });
}

double ShiftRegression::rise_to(const Eigen::VectorXcd& left) const {
  double out = 0.0;
  for_bands(bands_, [&](Index at, Index n) {
    out += kOfHannWindow * spectra_.independent * static_cast<double>(n) *
           std::log(before_.segment(at, n).squaredNorm() / left.segment(at, n).squaredNorm());
  });
  return out;
}

Eigen::VectorXcd ShiftRegression::shift(const ShiftResponse& response) const {
  Eigen::VectorXcd out = causes_.col(0);
  for (Index i = 0; i < out.size(); ++i) {
    const double hz = spectra_.bin_hz * static_cast<double>(bins_[static_cast<std::size_t>(i)]);
    const std::complex<double> form = response.form(hz);
    out(i) *= form / (1.0 - response.gain * form);
  }
  return out;
}

double ShiftRegression::gain_of(const Eigen::VectorXd& values, Index column) const {
  const double apart = 1.0 - values(0);
  return -values(causes_.cols() + column) / std::copysign(std::max(std::abs(apart), kLeastApart), apart);
}

FittedShift ShiftRegression::best_of_grid(double gain) const {
  FittedShift best;
  for (int c = 0; c < kCorners; ++c) {
    const double corner_hz = kSlowest_hz * std::pow(kFastest_hz / kSlowest_hz, static_cast<double>(c) / (kCorners - 1));
    for (int lag = 0; lag <= kLags; ++lag) {
      const double lag_s = lag * kLagStep_s;
      const Solution solution = solve(shift({gain, corner_hz, lag_s}));
      const double rise = rise_to(solution.left);
      if (rise > best.rise) best.response = {gain_of(solution.values, 0), corner_hz, lag_s}, best.rise = rise;
    }
  }
  return best;
}

void ShiftRegression::refine(FittedShift& fitted) const {
  ShiftResponse& response = fitted.response;
  const double up_hz = 0.02 * response.corner_hz, later_s = 0.1 * kLagStep_s;
  const auto near = [&](double by_hz, double by_s) {
    return shift({response.gain, response.corner_hz + by_hz, response.lag_s + by_s});
  };
  Eigen::MatrixXcd columns(size(), 3);
  columns << near(0.0, 0.0), response.gain * (near(up_hz, 0.0) - near(-up_hz, 0.0)) / (2.0 * up_hz),
      response.gain * (near(0.0, later_s) - near(0.0, -later_s)) / (2.0 * later_s);
  const Solution solution = solve(columns);
  const double apart = std::max(std::abs(1.0 - solution.values(0)), kLeastApart);
  const auto sigma = [&](Index column) {
    const Index at = causes_.cols() + column;
    return std::sqrt(solution.covariance(at, at)) / apart;
  };
  fitted.gain_sigma = sigma(0), fitted.corner_sigma = sigma(1), fitted.lag_sigma = sigma(2);
  fitted.depths = solution.values(0);
  response.gain = std::clamp(gain_of(solution.values, 0), -kMostGain, kMostGain);
  response.corner_hz = std::max(response.corner_hz + gain_of(solution.values, 1), 0.5 * response.corner_hz);
  response.lag_s = std::max(response.lag_s + gain_of(solution.values, 2), 0.0);
}

FittedShift ShiftRegression::fit() const {
  if (bins_.empty()) return {};
  FittedShift out;
  for (const double start : kGains) {
    FittedShift now = best_of_grid(start);
    for (int step = 0; step < kSteps && now.rise > 0.0; ++step) {
      refine(now);
      now.rise = rise_to(solve(shift(now.response)).left);
    }
    if (now.rise > out.rise) out = std::move(now);
  }
  if (!(out.rise > 0.0)) return out;
  out.free_rise = rise_to(left_by_any());
  out.shift = Eigen::VectorXcd::Zero(spectra_.bins.cols());
  out.shift(bins_) = out.response.gain * shift(out.response);
  return out;
}

}  // namespace core::closure
