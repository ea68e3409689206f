#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "core/closure/observation/point_motion_model.h"

namespace core::closure {

// Spectral line: camera rotation in a narrow band, as caused by rotors. With a rolling shutter its phase advances from
// row to row, which determines the true frequency among the aliases: at the frames' common instants, motion at apparent
// frequency nu of alias order n (true frequency nu + n f_s) has the row-dependent phase exp(2 pi i n rho s_j). A band
// that extends beyond f_s / 2 appears a second time below it, mirrored, with opposite sense of rotation and alias order
// -(n + 1).
struct LineFinding {
  double apparent_hz = 0.0;  // middle of the band, 0 .. f_s / 2; 0 = no line
  int fold = 0;
  double half_width_hz = 0.0;
  double spread_hz = 0.0;  // half the distance between the 16 % and 84 % quantiles of its power above the noise
  double gain = 0.0;       // decrease of the held-out squares, in noise variances
  double next_gain = 0.0;  // gain of the second-best alias order

  // True for a frequency and width of a rotor whose speed is constant within one percent; slower and wider findings are
  // vibrations of the camera. If the readout does not determine the alias order, the true frequency is unknown and a
  // fixed width decides.
  [[nodiscard]] bool is_steady(double rate_hz, double readout_frames) const noexcept {
    constexpr double kSlowestRotor_hz = 30.0;
    if (std::abs(readout_frames) < 0.1) return spread_hz <= 0.4;
    const double true_hz = std::abs(apparent_hz + fold * rate_hz);
    return true_hz > kSlowestRotor_hz && spread_hz <= 0.05 + 0.01 * true_hz;
  }
};

// Mean apparent frequency (0 .. f_s / 2) and its standard deviation, from eight parts of the record.
struct LineFrequency {
  double apparent_hz = 0.0, sigma_hz = 0.0;
};

// Rotation angles of a finding's motion: rms about roll, pitch and yaw over the record, corrected for noise, and their
// standard deviations, rad.
struct LineAngles {
  std::array<double, 3> rms{}, sigma{};
};

struct LineMotion {
  Eigen::MatrixXd px;    // 2 points x frames
  double freedom = 0.0;  // that it takes from the noise
};

class LineSearch {
 public:
  static constexpr int kMostFolds = 8;
  static constexpr double kSlowest_hz = 3.5;        // slower rotations are separate effects
  static constexpr double kSlowestFolded_hz = 1.0;  // apparent frequency of lines above half the frame rate
  // fields: 2 points x 3, px per rad. The model must outlive it.
  LineSearch(const PointMotionModel& model, double rate_hz, double readout_frames, Eigen::MatrixXd fields,
             Eigen::Index n_frames);

  // spectrum: ResidualMoments::spectrum of a residual of n_frames, after the fit of the model.
  [[nodiscard]] LineFinding find(const Eigen::MatrixXcd& spectrum) const;
  // Gain in the finding's band of the best pattern of any other kind, learned on four fifths of its bins and scored on
  // the remaining fifth.
  [[nodiscard]] double pattern_gain(const Eigen::MatrixXcd& spectrum, const LineFinding& finding) const;
  // The finding's motion fitted to this residual (2 points x frames, in sigmas), each axis and part of the band less
  // its share of noise. later: points x frames, difference between a point's readout fraction and its mean, in
  // readouts.
  [[nodiscard]] LineMotion motion(const Eigen::MatrixXd& residual, const LineFinding& finding,
                                  const Eigen::MatrixXd& later) const;
  // motion_px: sum of motion().
  // residual: of the fit without this motion.
  [[nodiscard]] LineAngles angles(const Eigen::MatrixXd& motion_px, const Eigen::MatrixXd& residual,
                                  const LineFinding& finding) const;
  [[nodiscard]] LineFrequency frequency(const Eigen::MatrixXd& motion_px, const LineFinding& finding) const;

 private:
  struct Band {
    Eigen::Index first = 0, count = 0;
    [[nodiscard]] bool holds(Eigen::Index bin) const noexcept { return bin >= first && bin < first + count; }
  };
  struct Side {
    int fold = 0;
    double apparent_hz = 0.0;
    Band band;
  };
  [[nodiscard]] Eigen::MatrixXcd spectrum(const Eigen::MatrixXd& residual) const;
  // Inverse transform of one-sided bins as a complex (analytic) series, advanced by this number of frames.
  [[nodiscard]] Eigen::RowVectorXcd analytic(const Eigen::RowVectorXcd& bins, const Band& at, Eigen::Index n,
                                             double frames = 0.0) const;
  [[nodiscard]] Band band(double centre_hz, double half_width_hz) const;
  // The finding's band, and its mirror image if it extends below f_s / 2 and the rows distinguish the two.
  [[nodiscard]] std::vector<Side> sides(const LineFinding& finding) const;
  [[nodiscard]] std::vector<double> peaks(const Eigen::MatrixXcd& spectrum, double from_hz, double to_hz) const;
  [[nodiscard]] Eigen::MatrixXcd fields_of(int fold) const;
  // Fields of all sides that contain the bin, as columns.
  [[nodiscard]] Eigen::MatrixXcd fields_at(Eigen::Index bin, const std::vector<Side>& sides) const;
  // Turns about the three axes in each bin of the first side's band: axes x bins for each side.
  struct Turns {
    std::vector<Eigen::MatrixXcd> of_side;
    double freedom = 0.0;
  };
  [[nodiscard]] Turns turns(const Eigen::MatrixXcd& bins, const std::vector<Side>& both) const;
  // What the model leaves of the fields of a motion at this apparent frequency.
  [[nodiscard]] Eigen::MatrixXcd left_of(const Eigen::MatrixXcd& fields, double hz) const;
  // The same of an alias order, orthonormal.
  [[nodiscard]] Eigen::MatrixXcd columns_of(int fold, double hz) const;
  [[nodiscard]] double gain_of_columns(const Eigen::MatrixXcd& moments, const Eigen::MatrixXcd& g) const;
  [[nodiscard]] double band_gain(const Eigen::MatrixXcd& spectrum, const LineFinding& finding) const;
  void recentre(const Eigen::MatrixXcd& spectrum, LineFinding& finding) const;
  // Frequencies in the band at which its cumulative power above the noise reaches 16, 50 and 84 %, Hz.
  [[nodiscard]] std::array<double, 3> quantiles_hz(const Eigen::MatrixXcd& spectrum, const LineFinding& finding) const;
  void try_folds(const Eigen::MatrixXcd& spectrum, double apparent_hz, LineFinding& best) const;

  const PointMotionModel& model_;
  double rate_hz_, readout_frames_;
  Eigen::MatrixXd fields_;
  Eigen::Index n_frames_;
  int n_fft_;
};

}  // namespace core::closure
