#pragma once

#include <vector>

#include "core/geometry/camera_model.h"

namespace core {

// A flat chessboard; its inner corners, row by row, lie at (column, row) * square_mm.
struct ChessBoard {
  int columns = 9, rows = 6;  // inner corners
  double square_mm = 25.0;
  [[nodiscard]] std::size_t n_corners() const noexcept {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
};

// The board's inner corners in one raw image, px, row by row.
using BoardView = std::vector<Vector2>;

struct CameraFit {
  CameraModel camera;
  std::vector<double> sigma;  // standard deviations of fx fy cx cy (px) and of the coefficients; 0 = fixed, not fitted
  int n_coefficients = 0;     // number of fitted coefficients, from the first on
  double rms_px = 0.0;        // distance between observed and predicted corners, over all views
  double corner_sigma_px = 0.0;        // per axis, from the residual and the degrees of freedom
  std::vector<double> view_rms_px;     // per view
  std::vector<double> tilt_deg;        // per view: angle between the board's normal and the optical axis
  std::vector<BoardView> residual_px;  // per view: observed minus predicted
  double condition = 1.0;  // smallest eigenvalue of the correlation matrix of the information; 1 = independent
};

constexpr std::size_t kMinViews = 3;

// Zhang's method (2000): initial values from OpenCV, then Gauss-Newton over camera and all poses on the reprojection
// error; covariance from the Schur complement of the poses, scaled by the residual. Radial-tangential: k1 k2 p1 p2 k3;
// equidistant: k1 k2 k3 k4. The last coefficients are fixed at zero only if the fit would otherwise fold the image or
// not converge: fixing small ones would make the standard deviations of the others too small (tenfold, in trials). All
// views contain board.n_corners() finite corners. Throws std::runtime_error with what is missing.
[[nodiscard]] CameraFit fit_camera(const ChessBoard& board, const std::vector<BoardView>& views, LensModel lens,
                                   int width_px, int height_px);

// Selects the views to fit: at most `most`, spread over position, size, rotation and tilt of the board, the most
// different first, none closer to a selected one than a twentieth of the image or the equivalent. Ascending indices.
[[nodiscard]] std::vector<std::size_t> spread_views(const ChessBoard& board, const std::vector<BoardView>& views,
                                                    int width_px, int height_px, std::size_t most);

}  // namespace core
