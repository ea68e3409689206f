#include "core/closure/observation/remainder.h"

#include <algorithm>
#include <cmath>

#include "core/closure/observation/row_spectra.h"

namespace core::closure {
namespace {

constexpr double kInside = 0.8;      // of the pattern's squares: at the effect's frequencies, on its points
constexpr double kTail = 0.025;      // of the effect's squares, left out at either end of its band
constexpr double kMovesPoint = 0.1;  // of the effect's rms: a point that it moves

struct BandHz {
  double low = 0.0, high = 0.0;
};

// Frequencies that hold an effect's squares but their tails.
BandHz band_of(const Eigen::MatrixXd& motion_px, double rate_hz, double beside_hz) {
  const Eigen::MatrixXd moving = motion_px.colwise() - motion_px.rowwise().mean();
  const int n_fft = row_fft_size(moving);
  const Eigen::RowVectorXd power = row_spectra(moving, n_fft).cwiseAbs2().colwise().sum();
  const double whole = power.sum();
  BandHz out{0.0, 0.5 * rate_hz};
  double sum = 0.0;
  bool below = true;
  for (Eigen::Index b = 0; b < power.size(); ++b) {
    sum += power(b);
    const double hz = rate_hz * static_cast<double>(b) / n_fft;
    if (below && sum > kTail * whole) out.low = hz, below = false;
    if (sum >= (1.0 - kTail) * whole) {
      out.high = hz;
      break;
    }
  }
  return {out.low - beside_hz, out.high + beside_hz};
}

// Squares of a pattern's amplitude above the noise, in each bin of the residual's spectrum.
struct PatternPower {
  Eigen::RowVectorXd of_bin;
  double hz_per_bin = 0.0;
  [[nodiscard]] double within(const BandHz& band) const {
    double sum = 0.0;
    for (Eigen::Index b = 0; b < of_bin.size(); ++b) {
      const double hz = hz_per_bin * static_cast<double>(b);
      if (hz >= band.low && hz <= band.high) sum += of_bin(b);
    }
    return sum;
  }
};

PatternPower power_of(const Eigen::VectorXd& pattern_px, RungSet band, const FitView& fit,
                      const ResidualMoments& residual) {
  const Eigen::VectorXd whitened = fit.model.whitened(pattern_px);
  const Eigen::VectorXd beside = whitened - fit.model.q_high() * (fit.model.q_high().transpose() * whitened);
  const double squares = beside.squaredNorm();
  PatternPower out;
  out.of_bin = Eigen::RowVectorXd::Zero(residual.spectrum.cols());
  out.hz_per_bin = 0.5 * fit.record.rate_hz / static_cast<double>(residual.spectrum.cols() - 1);
  if (!(squares > 0.0)) return out;
  const double noise = static_cast<double>(fit.record.n_frames()) / static_cast<double>(residual.spectrum.cols() - 1);
  const Rungs& rungs = fit.held_out.rungs();
  for (Eigen::Index b = 0; b < out.of_bin.size(); ++b) {
    const std::size_t rung = rungs.of(out.hz_per_bin * static_cast<double>(b));
    if (band != kAllRungs && !holds(band, rung)) continue;
    const double power = std::norm(beside.cast<std::complex<double>>().dot(residual.spectrum.col(b)));
    out.of_bin(b) = (power / squares - noise) / squares;
  }
  return out;
}

// Of the pattern's squares, on points that the effect moves.
double share_on_points(const Eigen::VectorXd& pattern_px, const Eigen::VectorXd& rms_px) {
  const double bar = kMovesPoint * std::sqrt(rms_px.squaredNorm() / static_cast<double>(rms_px.size()));
  double sum = 0.0;
  for (Eigen::Index i = 0; i < pattern_px.size(); i += 2) {
    if (rms_px.segment<2>(i).norm() > bar) sum += pattern_px.segment<2>(i).squaredNorm();
  }
  return sum / pattern_px.squaredNorm();
}

}  // namespace

std::optional<Remainder> remainder_of(const Eigen::VectorXd& pattern_px, RungSet band, const ObservationFit& fit,
                                      const ResidualMoments& residual) {
  if (!(pattern_px.squaredNorm() > 0.0)) return std::nullopt;
  const FitView view = fit.view();
  const PatternPower power = power_of(pattern_px, band, view, residual);
  const double whole = power.of_bin.sum();
  const auto n_values = static_cast<double>(pattern_px.size() * view.record.n_frames());
  const double rms = std::sqrt(std::max(whole, 0.0) * pattern_px.squaredNorm() / n_values);
  for (std::size_t i = 0; i < fit.effects().size(); ++i) {
    const EffectInModel& effect = *fit.effects()[i];
    if (effect.kind() != EffectKind::kNamed) continue;
    const Leaves leaves = effect.leaves();
    const Eigen::MatrixXd motion = effect.motion_px(fit.amplitude(i));
    if (motion.size() == 0) continue;
    const Eigen::VectorXd of_row =
        (motion.colwise() - motion.rowwise().mean()).rowwise().norm() / std::sqrt(static_cast<double>(motion.cols()));
    const double of_effect = std::sqrt(of_row.squaredNorm() / static_cast<double>(of_row.size()));
    if (!(rms < leaves.share * of_effect) || share_on_points(pattern_px, of_row) < kInside) continue;
    if (power.within(band_of(motion, view.record.rate_hz, leaves.beside_hz)) < kInside * whole) continue;
    return Remainder{effect.name(), rms / of_effect};
  }
  return std::nullopt;
}

}  // namespace core::closure
