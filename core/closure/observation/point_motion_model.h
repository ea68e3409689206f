#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "core/closure/observation/aliased_motion.h"
#include "core/closure/observation/frame_shift.h"
#include "core/closure/observation/observation_record.h"
#include "core/closure/observation/point_correlation.h"
#include "core/closure/observation/rungs.h"

namespace core::closure {

// Mean positions of the points: in units of the focal length about the principal point, and as readout fraction.
struct PointGeometry {
  double alpha_px = 0.0;
  Eigen::VectorXd x, y, share;
};
[[nodiscard]] PointGeometry point_geometry(const ObservationRecord& record);

// Points x frames, in readouts: difference between the readout fraction of a point at these positions (2 points x
// frames, px) and its mean, caused by drift over the rows.
[[nodiscard]] Eigen::MatrixXd later_in_readout(const ObservationRecord& record, const Eigen::MatrixXd& positions);

// Motion of the points, free in every frame, relative to their mean positions (rows 2j, 2j+1 = u, v of point j). Noise
// of neighbours is correlated; everything called "in sigmas" is whitened: divided by the point's sigma, correlation
// removed (PointCorrelation). Point j is seen rho s_j after the start of the frame (rho: readout in frames, s_j:
// readout fraction):
//     z_kj = sum_c X_jc a_c(k + rho s_j)
// Columns: each structure and base region along its axis; translation and zoom of the structure's plane;
// translation and zoom of the background; added columns. A translation spanned by the regions is dropped (rank).
//
// The series of the points are interpolated to one common instant of each frame, the middle of the readout
// (band-limited, FrameShift). There z = X a is a linear fit in each frame. A shift in time changes neither the variance
// nor the whiteness of the noise. The fit is therefore the exact joint least-squares solution for motion of any
// spectrum up to half the frame rate: nothing is differentiated, and no part of the motion remains in the residual.
// Motion above half the rate is modelled by AliasedMotion. The drift of a point over the rows changes its readout
// fraction (set_drift); this change times the point's velocity is removed first. Velocities are those of the motion
// without noise (FrameShift::signal_rates).
//
// Columns added for a band exist in some rungs of the spectrum only (rungs.h): there they are fitted with all others,
// elsewhere they are zero. Cosines make this exact. All such columns share one band.
class PointMotionModel {
 public:
  static constexpr double kLowBand_hz = 3.0;  // slow: where cameras drift; the band as long as no column needs another
  static constexpr Eigen::Index kPlaneColumns = 3;  // of a plane: translation along u, along v, zoom
  static constexpr double kCommonShare = 0.5;       // place in the readout of the frames' common instant

  explicit PointMotionModel(const ObservationRecord& record);  // record: checked
  PointMotionModel(const PointMotionModel&) = delete;          // a part of it refers to it
  PointMotionModel& operator=(const PointMotionModel&) = delete;
  // Moves the points to these mean positions (2 points long, px): after a lens correction, zoom acts on the
  // undistorted image. Added columns are dropped; readout instants are unchanged. magnification: factor of each
  // point's noise.
  void set_places(const ObservationRecord& record, const Eigen::VectorXd& places_px,
                  const Eigen::VectorXd& magnification);

  // Other sigmas of the points and correlation of their noise; followed by set_places().
  void set_noise(const ObservationRecord& record, PointCorrelation correlation);

  // Fields in px per unit, vectors of 2 points.
  void set_added(const std::vector<Eigen::VectorXd>& full, const std::vector<Eigen::VectorXd>& low, RungSet band);
  // As later_in_readout(); empty: not at all.
  void set_drift(Eigen::MatrixXd later) { later_ = std::move(later); }
  // positions: 2 points x frames, px, finite. All accessors below refer to this fit.
  void solve(const Eigen::MatrixXd& positions, double readout_frames, int rounds);

  // At the frames' common instants, in sigmas.
  [[nodiscard]] const Eigen::MatrixXd& residual() const noexcept { return residual_; }
  [[nodiscard]] Eigen::MatrixXd residual_px() const;  // at the instants of the points' own rows, in the raw image
  // Interpolates series of the points' rows (2 points x frames, px) to the common instants of the last solve().
  [[nodiscard]] Eigen::MatrixXd at_common_instants(Eigen::MatrixXd series) const;
  // And back.
  [[nodiscard]] Eigen::MatrixXd at_own_instants(Eigen::MatrixXd series) const;
  // left_of() the series (px) at the common instants, whitened and weighted like the residual.
  [[nodiscard]] Eigen::MatrixXd left_at_common_instants(Eigen::MatrixXd series) const;
  // Series over frames, px (added columns: their unit), one row per column, at the mean instant of the column's points;
  // zero for dropped columns.
  [[nodiscard]] const Eigen::MatrixXd& amplitudes() const noexcept { return amplitude_; }
  [[nodiscard]] const Eigen::MatrixXd& common_amplitudes() const noexcept { return common_; }  // at the common instants
  // Standard deviation of a column's amplitude by noise, in the band of the added columns; infinite for dropped
  // columns.
  [[nodiscard]] double sigma_of_column(Eigen::Index column) const;
  // At the common instants: motion of this point by the own columns other than zoom, along u and v; 2 x frames, px.
  [[nodiscard]] Eigen::MatrixXd translation_of_point(Eigen::Index point) const;
  [[nodiscard]] const Eigen::MatrixXd& rates() const noexcept { return rate_; }  // change of their signal per frame
  [[nodiscard]] Eigen::Index row_of_region(std::size_t region) const noexcept {
    return region_row_[region];
  }                                                                     // -1: none
  [[nodiscard]] Eigen::Index n_own() const noexcept { return n_own_; }  // columns before the added ones
  // Rows of the structure's plane among the own columns: translation along u, along v, zoom.
  [[nodiscard]] Eigen::Index first_plane_row() const noexcept { return n_region_; }
  // The same of the background's plane; -1: no background.
  [[nodiscard]] Eigen::Index first_background_row() const noexcept {
    return n_own_ - n_region_ > kPlaneColumns ? n_region_ + kPlaneColumns : -1;
  }
  // Row of the zoom that moves this point (of the structure's plane or of the background) among the own columns; -1:
  // none. Its series is relative.
  [[nodiscard]] Eigen::Index zoom_row_of(Eigen::Index point) const noexcept {
    return zoom_row_of_point_[static_cast<std::size_t>(point)];
  }
  [[nodiscard]] Eigen::RowVectorXd zoom_of_point(Eigen::Index point) const;
  // Number of leading columns of q_high() and q_low() that stem from own columns.
  [[nodiscard]] Eigen::Index own_rank() const noexcept { return own_rank_; }
  [[nodiscard]] double share_of_column(Eigen::Index column) const { return share_(column); }
  // Derivative of the prediction by the readout time (frames), px, at the instants of the points' own rows.
  [[nodiscard]] Eigen::MatrixXd readout_field() const;

  // Residual of a field or record at the frames' common instants after the fit, 2 points x frames in sigmas, without
  // its mean over time.
  [[nodiscard]] Eigen::MatrixXd left_of(const Eigen::MatrixXd& values) const;
  // Residual of fields of a motion at one apparent frequency (whitened), outside the added columns' band; weighted like
  // the residual's.
  [[nodiscard]] Eigen::MatrixXcd left_at(double hz, const Eigen::MatrixXcd& fields) const;
  // Amplitudes that the columns outside the band take of whitened fields, beside which these leave their residual.
  [[nodiscard]] Eigen::MatrixXd amplitudes_of(const Eigen::MatrixXd& whitened) const;
  // Orthonormal columns outside and within the band of the added columns.
  [[nodiscard]] const Eigen::MatrixXd& q_high() const noexcept { return q_high_; }
  [[nodiscard]] const Eigen::MatrixXd& q_low() const noexcept { return q_low_; }
  [[nodiscard]] RungSet band() const noexcept { return band_; }
  [[nodiscard]] Eigen::Index n_frames() const noexcept { return n_frames_; }
  // Fields or series in px (2 points x any number, real or complex), whitened; and back.
  template <class Matrix>
  [[nodiscard]] Matrix whitened(const Matrix& px) const {
    return correlation_.removed<Matrix>(weight_.cast<typename Matrix::Scalar>().asDiagonal() * px);
  }
  template <class Matrix>
  [[nodiscard]] Matrix in_px(const Matrix& whitened) const {
    return weight_.cwiseInverse().cast<typename Matrix::Scalar>().asDiagonal() * correlation_.put_back(whitened);
  }
  [[nodiscard]] const PointCorrelation& correlation() const noexcept { return correlation_; }
  [[nodiscard]] const Eigen::VectorXd& weight() const noexcept { return weight_; }  // 1 / sigma, per row
  [[nodiscard]] const PointGeometry& geometry() const noexcept { return geometry_; }

 private:
  void add_region_columns(const ObservationRecord& record);
  void add_plane_columns(const ObservationRecord& record);
  void factorise();
  void place_in_readout();
  void place_rows(const Eigen::MatrixXd& rows, Eigen::Index first, Eigen::MatrixXd& all) const;
  void fit_columns(const Eigen::MatrixXd& z);
  void estimate_rates();
  [[nodiscard]] Eigen::VectorXd row_instants() const;
  [[nodiscard]] Eigen::VectorXd column_instants() const;
  [[nodiscard]] Eigen::MatrixXd velocities() const;
  void fit_common(const Eigen::MatrixXd& z);

  double rate_hz_;
  Rungs rungs_;
  RungSet band_;
  FrameShift shift_;
  std::optional<AliasedMotion> aliased_;
  double readout_frames_ = 0.0;
  PointGeometry geometry_;
  Eigen::VectorXd weight_, sigma_px_;
  PointCorrelation correlation_;
  Eigen::Index n_frames_;
  Eigen::MatrixXd cosines_;                        // of the band; empty while no column is added for it
  std::vector<Eigen::VectorXd> own_, full_, low_;  // fields, px
  std::vector<Eigen::Index> region_row_, zoom_row_of_point_;
  Eigen::Index n_own_ = 0, n_region_ = 0, own_rank_ = 0;
  Eigen::VectorXd share_;           // mean readout fraction of the column's points
  Eigen::MatrixXd x_px_, x_;        // fields, whitened ones
  Eigen::MatrixXd later_;           // see set_drift()
  std::vector<Eigen::Index> kept_;  // columns of q_high_ first, then those that the low band adds
  // q_low_ = [q_high_, extra_]. solve_high_: z -> amplitudes; solve_extra_: z in the low band -> amplitudes of the
  // columns in extra_; give_back_: these amplitudes -> their correction of the previous amplitudes.
  Eigen::MatrixXd q_high_, q_low_, extra_, solve_high_, solve_extra_, give_back_;
  // common_: amplitudes at the common instants; rate_common_: change of their signal per frame.
  Eigen::MatrixXd common_, rate_common_, amplitude_, rate_, residual_;
};

}  // namespace core::closure
