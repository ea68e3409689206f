#include "core/closure/observation/remainder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "core/closure/observation/power_quantiles.h"
#include "core/closure/observation/row_spectra.h"

namespace core::closure {
namespace {

constexpr double kInside = 0.8;      // of the pattern's squares: at the effect's frequencies, on its points
constexpr double kTail = 0.025;      // of the effect's squares, left out at either end of its band
constexpr double kMovesPoint = 0.1;  // of the effect's rms: a point that it moves

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

double rms_of(const Eigen::VectorXd& rms_px) {
  return std::sqrt(rms_px.squaredNorm() / static_cast<double>(rms_px.size()));
}

// Of the pattern's squares, on points that the effect moves.
double share_on_points(const Eigen::VectorXd& pattern_px, const Eigen::VectorXd& rms_px) {
  const double bar = kMovesPoint * rms_of(rms_px);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < pattern_px.size(); i += 2) {
    if (rms_px.segment<2>(i).norm() > bar) sum += pattern_px.segment<2>(i).squaredNorm();
  }
  return sum / pattern_px.squaredNorm();
}

}  // namespace

BandHz band_of(const Eigen::MatrixXd& motion_px, double rate_hz, double beside_hz) {
  const int n_fft = row_fft_size(motion_px);
  const Eigen::VectorXd power = row_spectra(motion_px, n_fft).cwiseAbs2().colwise().sum().transpose();
  const auto [low, high] = power_quantiles(power, std::array{kTail, 1.0 - kTail});
  const double bin_hz = rate_hz / n_fft;
  return {bin_hz * static_cast<double>(low) - beside_hz, bin_hz * static_cast<double>(high) + beside_hz};
}

Remainders::Remainders(const ObservationFit& fit, const ResidualMoments& residual)
    : view_(fit.view()), residual_(residual) {
  for (std::size_t i = 0; i < fit.effects().size(); ++i) {
    const EffectInModel& effect = *fit.effects()[i];
    if (effect.kind() != EffectKind::kNamed) continue;
    Eigen::MatrixXd motion = effect.motion_px(fit.amplitude(i));
    if (motion.size() == 0) continue;
    motion.colwise() -= motion.rowwise().mean().eval();
    const Leaves leaves = effect.leaves();
    adopted_.push_back({effect.name(), leaves.share,
                        motion.rowwise().norm() / std::sqrt(static_cast<double>(motion.cols())),
                        band_of(motion, view_.record.rate_hz, leaves.beside_hz)});
  }
}

std::optional<Remainder> Remainders::find(const Eigen::VectorXd& pattern_px, RungSet band) const {
  if (adopted_.empty() || !(pattern_px.squaredNorm() > 0.0)) return std::nullopt;
  const PatternPower power = power_of(pattern_px, band, view_, residual_);
  const double whole = power.of_bin.sum();
  const auto n_values = static_cast<double>(pattern_px.size() * view_.record.n_frames());
  const double rms = std::sqrt(std::max(whole, 0.0) * pattern_px.squaredNorm() / n_values);
  for (const Adopted& effect : adopted_) {
    const double of_effect = rms_of(effect.rms_px);
    if (rms < effect.most_share * of_effect && share_on_points(pattern_px, effect.rms_px) >= kInside &&
        power.within(effect.band) >= kInside * whole)
      return Remainder{effect.name, rms / of_effect};
  }
  return std::nullopt;
}

}  // namespace core::closure
