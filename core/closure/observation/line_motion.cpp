// LineSearch: motion, angles and frequency of a finding.
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/closure/observation/line_search.h"
#include "core/spectrum/real_fft.h"

namespace core::closure {
namespace {

constexpr int kStretches = 8;

}  // namespace

Eigen::RowVectorXcd LineSearch::analytic(const Eigen::RowVectorXcd& bins, const Band& at, Eigen::Index n,
                                         double frames) const {
  RealFft fft(n_fft_);
  std::vector<std::complex<double>> part(static_cast<std::size_t>(fft.n_bins()), 0.0);
  std::vector<double> cosine(static_cast<std::size_t>(n_fft_)), sine = cosine;
  for (Eigen::Index i = 0; i < at.count; ++i) {
    const double angle = 2.0 * std::numbers::pi * frames * static_cast<double>(at.first + i) / n_fft_;
    part[static_cast<std::size_t>(at.first + i)] = bins(i) / std::sqrt(2.0 / n_fft_) * std::polar(1.0, angle);
  }
  fft.inverse(part, cosine);
  for (std::complex<double>& bin : part) bin *= std::complex<double>(0.0, -1.0);
  fft.inverse(part, sine);
  Eigen::RowVectorXcd out(n);
  for (Eigen::Index k = 0; k < n; ++k)
    out(k) = {cosine[static_cast<std::size_t>(k)], sine[static_cast<std::size_t>(k)]};
  return out;
}

Eigen::MatrixXd LineSearch::motion(const Eigen::MatrixXd& residual, const LineFinding& finding,
                                   const Eigen::MatrixXd& later) const {
  const std::vector<Side> both = sides(finding);
  const Band b = both.front().band;
  const Eigen::MatrixXcd bins = spectrum(residual).middleCols(b.first, b.count);
  std::vector<Eigen::MatrixXcd> motion(both.size(), Eigen::MatrixXcd::Zero(bins.rows(), bins.cols()));
  for (Eigen::Index c = 0; c < b.count; ++c) {
    const Eigen::MatrixXcd fields = fields_at(b.first + c, both), w = left_of(fields);
    const Eigen::VectorXcd amplitude = (w.adjoint() * w).ldlt().solve(w.adjoint() * bins.col(c));
    for (std::size_t side = 0, at = 0; side < both.size(); ++side) {
      if (!both[side].band.holds(b.first + c)) continue;
      const auto first = static_cast<Eigen::Index>(at++) * fields_.cols();
      motion[side].col(c) = fields.middleCols(first, fields_.cols()) * amplitude.segment(first, fields_.cols());
    }
  }
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(residual.rows(), residual.cols());
  for (std::size_t side = 0; side < both.size(); ++side) {
    const double turns = (both[side].apparent_hz + both[side].fold * rate_hz_) / rate_hz_ * readout_frames_;
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      const double frames = readout_frames_ * (model_.geometry().share(i / 2) - PointMotionModel::kCommonShare);
      const Eigen::RowVectorXcd series = analytic(motion[side].row(i), b, out.cols(), frames);
      for (Eigen::Index k = 0; k < out.cols(); ++k)
        out(i, k) += (series(k) * std::polar(1.0, 2.0 * std::numbers::pi * turns * later(i / 2, k))).real();
    }
  }
  return out;
}

// In every bin the motion is a combination of the fields, except for the drift of points over the rows.
LineAngles LineSearch::angles(const Eigen::MatrixXd& motion_px, const LineFinding& finding) const {
  const Band b = band(finding.apparent_hz, finding.half_width_hz);
  LineAngles out;
  if (b.count < 1) return out;
  const Eigen::MatrixXcd bins =
      spectrum(model_.whitened(model_.at_common_instants(motion_px))).middleCols(b.first, b.count);
  const Eigen::MatrixXcd seen = fields_of(finding.fold);
  const Eigen::MatrixXcd left = left_of(seen), fields = model_.whitened(seen);
  const Eigen::MatrixXcd amplitude = (fields.adjoint() * fields).ldlt().solve(fields.adjoint() * bins);
  const Eigen::MatrixXcd covariance =
      (left.adjoint() * left).ldlt().solve(Eigen::MatrixXcd::Identity(fields.cols(), fields.cols()));
  const auto n = static_cast<double>(n_frames_);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double noise = covariance(axis, axis).real();  // per frame, over the whole spectrum
    const double power = amplitude.row(axis).squaredNorm() / n - 2.0 * static_cast<double>(b.count) / n_fft_ * noise;
    const auto i = static_cast<std::size_t>(axis);
    out.rms[i] = std::sqrt(std::max(power, 0.0)), out.sigma[i] = std::sqrt(noise / n);
  }
  return out;
}

// Phase advance of the analytic signal of the strongest row, in successive parts of the record.
LineFrequency LineSearch::frequency(const Eigen::MatrixXd& motion_px, const LineFinding& finding) const {
  Eigen::Index row = 0;
  motion_px.rowwise().squaredNorm().maxCoeff(&row);
  const Eigen::Index n = motion_px.cols(), length = (n - 1) / kStretches;
  const Band b = band(finding.apparent_hz, finding.half_width_hz);
  const Eigen::RowVectorXcd bins = spectrum(motion_px.row(row)).row(0).segment(b.first, b.count);
  const Eigen::RowVectorXcd series = analytic(bins, b, n);
  std::array<double, kStretches> hz{};
  double mean = 0.0, squares = 0.0;
  for (int s = 0; s < kStretches; ++s) {
    std::complex<double> advance = 0.0;
    for (Eigen::Index k = s * length; k < (s + 1) * length; ++k) advance += series(k + 1) * std::conj(series(k));
    hz[static_cast<std::size_t>(s)] = std::arg(advance) * rate_hz_ / (2.0 * std::numbers::pi);
    mean += hz[static_cast<std::size_t>(s)] / kStretches;
  }
  for (const double f : hz) squares += (f - mean) * (f - mean);
  return {mean, std::sqrt(squares / (kStretches * (kStretches - 1.0)))};
}

}  // namespace core::closure
