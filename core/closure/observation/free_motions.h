#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/closure/observation/fit_view.h"

namespace core::closure {

// Motions that the model leaves free in every frame, as series at the frames' common instants. Some effects are
// absorbed by them completely: they leave no residual, and show only in what one motion does beyond the others.
struct FreeMotions {
  double rate_hz = 0.0;
  Eigen::MatrixXd structure;           // regions along their axes, translations of the structure's plane; px
  Eigen::MatrixXd base;                // 2 rows: translation of the base (without one: of the plane), along u, v; px
  Eigen::Vector2d still;               // direction in which the base does not move by itself; zero: there is none
  Eigen::RowVectorXd structure_zoom;   // relative
  Eigen::MatrixXd background;          // 2 rows: translation along u and v; px
  Eigen::RowVectorXd background_zoom;  // relative
  Eigen::Vector2d background_sigma;    // of each of its values by noise, px
  double background_zoom_sigma = 0.0;
  Eigen::MatrixXd added;  // amplitudes of adopted patterns
};
// Empty: the record has no background, or too few points on it.
[[nodiscard]] std::optional<FreeMotions> free_motions(const FitView& fit);

// What a series does beyond its causes (rows of the same length): least squares on each cause, its first and its second
// difference, so that a cause may act with the gain and lag of a mechanical system.
[[nodiscard]] Eigen::RowVectorXd beyond_causes(const Eigen::RowVectorXd& series, const Eigen::MatrixXd& causes);

// Spectra of series with a Hann window: white noise of unit variance has mean square 1 in every bin.
inline constexpr double kOfHannWindow = 2.0 / 3.0;  // of independent values, that the window leaves to a band
struct TaperedSpectra {
  Eigen::MatrixXcd bins;  // series x bins
  double bin_hz = 0.0;
  double independent = 1.0;  // independent values per bin

  [[nodiscard]] Eigen::Index bin_of(double hz) const noexcept;
};
[[nodiscard]] TaperedSpectra tapered_spectra(const Eigen::MatrixXd& series, double rate_hz);

// What the first series does beyond all others at each frequency: regression on them over the bins within 0.5 Hz (more
// in short records), with complex coefficients that change linearly there. Corrected for the degrees of freedom taken;
// bins closer to the ends of the spectrum than that are zero.
[[nodiscard]] Eigen::VectorXcd beyond_neighbours(const TaperedSpectra& spectra);

// Gain of the hypothesis that n independent powers have this mean instead of a given level, in units of chi-square / 2.
[[nodiscard]] double power_gain(double mean, double level, double n) noexcept;

}  // namespace core::closure
