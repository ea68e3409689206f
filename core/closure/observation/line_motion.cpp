// LineSearch: motion, angles and frequency of a finding.
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "core/closure/observation/line_search.h"
#include "core/spectrum/real_fft.h"

namespace core::closure {
namespace {

constexpr int kStretches = 8;
constexpr double kPart_hz = 0.25;  // of a band, in which the share of noise is estimated

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

// Least squares in each bin. Each axis and part of the band is then reduced by the share of noise in its squares
// (Wiener): an axis that does not turn, and the far tails of a resonance, would add noise alone.
LineSearch::Turns LineSearch::turns(const Eigen::MatrixXcd& bins, const std::vector<Side>& both) const {
  const Band b = both.front().band;
  const Eigen::Index n_axes = fields_.cols();
  const double bin_hz = rate_hz_ / n_fft_;
  const double per_bin = 2.0 * static_cast<double>(n_frames_) / n_fft_;  // squares of noise of unit variance
  const auto part = std::max<Eigen::Index>(1, std::lround(kPart_hz * n_fft_ / rate_hz_));
  Turns out{std::vector<Eigen::MatrixXcd>(both.size(), Eigen::MatrixXcd::Zero(n_axes, b.count)), 0.0};
  std::vector<Eigen::MatrixXd> noise(both.size(), Eigen::MatrixXd::Zero(n_axes, b.count));
  for (Eigen::Index c = 0; c < b.count; ++c) {
    const Eigen::MatrixXcd w = left_of(fields_at(b.first + c, both), bin_hz * static_cast<double>(b.first + c)),
                           squares = w.adjoint() * w;
    const Eigen::MatrixXcd inverse = squares.ldlt().solve(Eigen::MatrixXcd::Identity(w.cols(), w.cols()));
    const Eigen::VectorXcd turn = inverse * (w.adjoint() * bins.col(c));
    Eigen::Index first = 0;
    for (std::size_t side = 0; side < both.size(); ++side) {
      if (!both[side].band.holds(b.first + c)) continue;
      out.of_side[side].col(c) = turn.segment(first, n_axes);
      noise[side].col(c) = per_bin * inverse.diagonal().segment(first, n_axes).real();
      first += n_axes;
    }
  }
  for (std::size_t side = 0; side < both.size(); ++side) {
    for (Eigen::Index c = 0; c < b.count; c += part) {
      const Eigen::Index count = std::min(part, b.count - c);
      for (Eigen::Index axis = 0; axis < n_axes; ++axis) {
        auto of_part = out.of_side[side].row(axis).segment(c, count);
        const Eigen::RowVectorXd of_bin = noise[side].row(axis).segment(c, count);
        const double power = of_part.squaredNorm(), of_noise = of_bin.sum();
        const double kept = power > of_noise ? 1.0 - of_noise / power : 0.0;
        of_part *= kept;
        out.freedom += kept * per_bin * static_cast<double>((of_bin.array() > 0.0).count());
      }
    }
  }
  return out;
}

LineMotion LineSearch::motion(const Eigen::MatrixXd& residual, const LineFinding& finding,
                              const Eigen::MatrixXd& later) const {
  const std::vector<Side> both = sides(finding);
  const Band b = both.front().band;
  const Eigen::MatrixXcd bins = spectrum(residual).middleCols(b.first, b.count);
  const Turns found = turns(bins, both);
  std::vector<Eigen::MatrixXcd> motion;
  for (std::size_t side = 0; side < both.size(); ++side)
    motion.emplace_back(fields_of(both[side].fold) * found.of_side[side]);
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
  return {std::move(out), found.freedom};
}

// In every bin the motion is a combination of the fields, except for the drift of points over the rows. What was kept
// out of it as noise is still in the residual, and is counted.
LineAngles LineSearch::angles(const Eigen::MatrixXd& motion_px, const Eigen::MatrixXd& residual,
                              const LineFinding& finding) const {
  const Band b = band(finding.apparent_hz, finding.half_width_hz);
  LineAngles out;
  if (b.count < 1) return out;
  const Eigen::MatrixXcd bins =
      spectrum(model_.whitened(model_.at_common_instants(motion_px))).middleCols(b.first, b.count);
  const Eigen::MatrixXcd seen = fields_of(finding.fold);
  const Eigen::MatrixXcd left = left_of(seen, finding.apparent_hz), fields = model_.whitened(seen);
  Eigen::MatrixXcd amplitude = (fields.adjoint() * fields).ldlt().solve(fields.adjoint() * bins);
  amplitude += (left.adjoint() * left).ldlt().solve(left.adjoint() * spectrum(residual).middleCols(b.first, b.count));
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
