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
  std::vector<double> sigma;  // standard deviations of fx fy cx cy (px) and of the coefficients; 0 = held, not fitted
  int n_coefficients = 0;     // fitted ones, from the first on
  double rms_px = 0.0;        // distance of the seen corner from the predicted one, over all
  double corner_sigma_px = 0.0;        // per axis, residual over degrees of freedom
  std::vector<double> view_rms_px;     // per view
  std::vector<double> tilt_deg;        // per view: the board's normal against the optical axis
  std::vector<BoardView> residual_px;  // per view: seen minus predicted
  double condition = 1.0;  // least eigenvalue of the correlation matrix of the parameters' information; 1 = all apart
};

constexpr std::size_t kMinViews = 3;

// Zhang's method (2000): OpenCV's start, then Gauss-Newton over camera and all poses on the reprojection error;
// covariance from the Schur complement of the poses, scaled by the residual. Radial-tangential: k1 k2 p1 p2 k3;
// equidistant: k1 k2 k3 k4. The last ones are held at zero only where the fit would else fold the image or not settle:
// a coefficient held for being small would make the deviations of the others too small (by ten and more, in trials).
// All views hold board.n_corners() finite corners. Throws std::runtime_error saying what is missing when it fails.
[[nodiscard]] CameraFit fit_camera(const ChessBoard& board, const std::vector<BoardView>& views, LensModel lens,
                                   int width_px, int height_px);

// Which of many views to fit: at most `most`, spread over place, size, turn and tilt of the board, the most different
// first, none nearer to a chosen one than a twentieth of the image or its like. Ascending indices.
[[nodiscard]] std::vector<std::size_t> spread_views(const ChessBoard& board, const std::vector<BoardView>& views,
                                                    int width_px, int height_px, std::size_t most);

}  // namespace core
