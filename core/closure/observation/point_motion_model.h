#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"

namespace core::closure {

// Mean positions of the points, in units of the focal length about the principal point, and in the readout.
struct PointGeometry {
  double alpha_px = 0.0;
  Eigen::VectorXd x, y, share;
};
[[nodiscard]] PointGeometry point_geometry(const ObservationRecord& record);

// Motion of the points, free in every frame, relative to their mean positions (rows 2j, 2j+1 = u, v of point j, divided
// by its sigma):
//     z_kj = sum_c X_jc [ a_c(k) + rho (s_j - s_c) a_c'(k) + rho^2 (s_j - s_c)^2 a_c''(k) / 2 ]
// Columns: every region of structure and base along its axis; translation and zoom of the structure's plane;
// translation and zoom of the background; added ones. s: place in the readout, s_c: its mean over the column's points;
// rho: readout in frames. Translation spanned by the regions is dropped (rank). Camera columns are low-passed at 3 Hz
// before differentiation, because their noise would enter every point.
//
// Columns added for the low band exist up to kLowBand_hz only: there they are fitted with all others, above they are
// zero. Cosines make this exact.
class PointMotionModel {
 public:
  static constexpr double kLowBand_hz = 3.0;

  explicit PointMotionModel(const ObservationRecord& record);  // of a checked record
  // The same with the points at these mean positions (2 points long, px): after a lens correction, zoom acts on the
  // undistorted image. Added columns are dropped; readout instants are unchanged.
  // magnification: per point, by which the noise is multiplied.
  void set_places(const ObservationRecord& record, const Eigen::VectorXd& places_px,
                  const Eigen::VectorXd& magnification);

  // Fields in px per unit, vectors of 2 points.
  void set_added(const std::vector<Eigen::VectorXd>& full, const std::vector<Eigen::VectorXd>& low);
  // positions: 2 points x frames, px, finite. All accessors below refer to this fit.
  void solve(const Eigen::MatrixXd& positions, double readout_frames, int rounds);

  [[nodiscard]] const Eigen::MatrixXd& residual() const noexcept { return residual_; }  // in sigmas
  [[nodiscard]] Eigen::MatrixXd residual_px() const;                                    // of the raw image
  // Series over frames, px (added columns: their unit), one row per column; zero where a column was dropped.
  [[nodiscard]] const Eigen::MatrixXd& amplitudes() const noexcept { return amplitude_; }
  [[nodiscard]] const Eigen::MatrixXd& rates() const noexcept { return first_; }  // their changes per frame
  [[nodiscard]] Eigen::Index row_of_region(std::size_t region) const noexcept {
    return region_row_[region];
  }                                                                     // -1: none
  [[nodiscard]] Eigen::Index n_own() const noexcept { return n_own_; }  // columns before the added ones, full, then low
  // Rows of the structure's plane among the own columns: its translation along u and v, its zoom.
  [[nodiscard]] Eigen::Index first_plane_row() const noexcept { return n_region_; }
  // Series of the zoom that moves this point: of the structure's plane, or of the background; relative.
  [[nodiscard]] Eigen::RowVectorXd zoom_of_point(Eigen::Index point) const;
  // Leading columns of q_high() and q_low() that come from own columns.
  [[nodiscard]] Eigen::Index own_rank() const noexcept { return own_rank_; }
  [[nodiscard]] double share_of_column(Eigen::Index column) const { return share_(column); }
  // Derivative of the prediction by the readout time in frames, in sigmas.
  [[nodiscard]] Eigen::MatrixXd readout_field() const;

  // Residual of a field or record after the fit, 2 points x frames in sigmas; its mean over time is removed.
  [[nodiscard]] Eigen::MatrixXd left_of(const Eigen::MatrixXd& values) const;
  // Orthonormal columns above and within the low band.
  [[nodiscard]] const Eigen::MatrixXd& q_high() const noexcept { return q_high_; }
  [[nodiscard]] const Eigen::MatrixXd& q_low() const noexcept { return q_low_; }
  [[nodiscard]] const Eigen::MatrixXd& cosines() const noexcept { return cosines_; }
  [[nodiscard]] const Eigen::VectorXd& weight() const noexcept { return weight_; }  // 1 / sigma, per row
  [[nodiscard]] const PointGeometry& geometry() const noexcept { return geometry_; }

 private:
  void add_region_columns(const ObservationRecord& record);
  void add_plane_columns(const ObservationRecord& record);
  void add_column(const Eigen::VectorXd& field, bool is_region);
  void factorise();
  void place_in_readout();
  [[nodiscard]] Eigen::MatrixXd fit_columns(const Eigen::MatrixXd& z);
  void differentiate(double rate_hz);

  double rate_hz_;
  double readout_frames_ = 0.0;
  PointGeometry geometry_;
  Eigen::VectorXd weight_, sigma_px_;
  Eigen::MatrixXd cosines_;
  std::vector<Eigen::VectorXd> own_, full_, low_;  // whitened fields
  std::vector<char> is_region_;
  std::vector<Eigen::Index> region_row_, zoom_row_of_point_;
  Eigen::Index n_own_ = 0, n_region_ = 0, own_rank_ = 0;
  Eigen::VectorXd share_;                   // s_c
  Eigen::MatrixXd x_, x_first_, x_second_;  // fields; times (s_j - s_c); times its square / 2
  std::vector<Eigen::Index> kept_;          // those of q_high_ first, then what the low band adds
  // q_low_ = [q_high_, extra_]. solve_high_: z -> amplitudes; solve_extra_: z in the low band -> amplitudes of what it
  // adds; give_back_: those -> what they take from the amplitudes before.
  Eigen::MatrixXd q_high_, q_low_, extra_, solve_high_, solve_extra_, give_back_;
  Eigen::MatrixXd amplitude_, first_, second_, residual_;
};

}  // namespace core::closure
