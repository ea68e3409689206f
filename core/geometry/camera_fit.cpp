#include "core/geometry/camera_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <string>

#include "core/geometry/camera_adjustment.h"
#include "core/geometry/lens_fault.h"

namespace core {
namespace {

std::vector<cv::Point3f> board_points(const ChessBoard& board) {
  std::vector<cv::Point3f> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column)
      points.emplace_back(static_cast<float>(column * board.square_mm), static_cast<float>(row * board.square_mm),
                          0.0F);
  }
  return points;
}

void check_views(const ChessBoard& board, const std::vector<BoardView>& views) {
  if (views.size() < kMinViews) {
    throw std::runtime_error("calibration: " + std::to_string(views.size()) + " views of the board, at least " +
                             std::to_string(kMinViews) + " are needed; better 20, tilted to all sides");
  }
  for (const BoardView& view : views) {
    const bool finite = std::all_of(view.begin(), view.end(),
                                    [](const Vector2& p) { return std::isfinite(p.u) && std::isfinite(p.v); });
    if (view.size() != board.n_corners() || !finite)
      throw std::runtime_error("calibration: a view without all corners of the board");
  }
}

CameraModel model_of(const cv::Mat& k, const cv::Mat& coefficients, LensModel lens) {
  CameraModel camera{k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2), k.at<double>(1, 2), {}, lens};
  for (int i = 0; i < 4; ++i) camera.distortion[static_cast<std::size_t>(i)] = coefficients.at<double>(i);
  return camera;
}

// OpenCV's fit with the fewest coefficients, as the initial value.
CameraAdjustment start(const ChessBoard& board, const std::vector<BoardView>& views, LensModel lens, cv::Size size) {
  const std::vector<std::vector<cv::Point3f>> objects(views.size(), board_points(board));
  std::vector<std::vector<cv::Point2f>> images;
  for (const BoardView& view : views) {
    std::vector<cv::Point2f>& image = images.emplace_back();
    for (const Vector2& p : view) image.emplace_back(static_cast<float>(p.u), static_cast<float>(p.v));
  }
  cv::Mat k = cv::Mat::eye(3, 3, CV_64F);
  cv::Mat coefficients = cv::Mat::zeros(4, 1, CV_64F);
  std::vector<cv::Mat> rotations, translations;
  if (lens == LensModel::kEquidistant) {
    constexpr int kFlags = cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW |
                           cv::fisheye::CALIB_FIX_K3 | cv::fisheye::CALIB_FIX_K4;
    cv::fisheye::calibrate(objects, images, size, k, coefficients, rotations, translations, kFlags);
  } else {
    cv::calibrateCamera(objects, images, size, k, coefficients, rotations, translations, cv::CALIB_FIX_K3);
  }
  CameraAdjustment out(board, views, model_of(k, coefficients, lens));
  for (std::size_t i = 0; i < views.size(); ++i) {
    cv::Mat r, rotation;
    rotations[i].reshape(1, 3).convertTo(r, CV_64F);
    cv::Rodrigues(r, rotation);
    cv::Mat t;
    translations[i].reshape(1, 3).convertTo(t, CV_64F);
    BoardPose pose;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) pose.rotation(row, column) = rotation.at<double>(row, column);
      pose.translation_mm(row) = t.at<double>(row);
    }
    out.set_pose(i, pose);
  }
  return out;
}

// Fits all coefficients; fewer only if the views do not determine them: the lens folds the image, or no solution.
int fit_with_possible_coefficients(CameraAdjustment& fit, LensModel lens, int width_px, int height_px) {
  const int least = lens == LensModel::kEquidistant ? 2 : 4;
  const int most = lens == LensModel::kEquidistant ? 4 : 5;
  for (int n = most; n > least; --n) {
    CameraAdjustment richer = fit;
    if (!richer.solve(n) || lens_fault(richer.camera(), width_px, height_px)) continue;
    fit = richer;
    return n;
  }
  fit.solve(least);
  return least;
}

// Features of a board's position, size, rotation and tilt, each scaled by the share of the image that it changes.
std::vector<double> look_of(const ChessBoard& board, const BoardView& view, int width_px, int height_px) {
  const auto columns = static_cast<std::size_t>(board.columns);
  const Vector2 a = view.front(), b = view[columns - 1], c = view.back(), d = view[view.size() - columns];
  const auto length = [](const Vector2& p, const Vector2& q) { return std::hypot(q.u - p.u, q.v - p.v); };
  Vector2 mean;
  for (const Vector2& p : view) mean.u += p.u, mean.v += p.v;
  const double n = static_cast<double>(view.size());
  const double area = 0.5 * std::abs((c.u - a.u) * (d.v - b.v) - (d.u - b.u) * (c.v - a.v));
  const double diagonal = std::hypot(width_px, height_px);
  const double turn = std::atan2(b.v - a.v, b.u - a.u);
  return {mean.u / n / width_px,
          mean.v / n / height_px,
          std::sqrt(area) / diagonal,
          std::log(length(a, b) / length(d, c)),
          std::log(length(a, d) / length(b, c)),
          0.3 * std::log(length(a, b) / length(a, d)),
          0.2 * std::cos(2.0 * turn),
          0.2 * std::sin(2.0 * turn)};
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

}  // namespace

CameraFit fit_camera(const ChessBoard& board, const std::vector<BoardView>& views, LensModel lens, int width_px,
                     int height_px) {
  check_views(board, views);
  CameraFit out;
  try {
    CameraAdjustment fit = start(board, views, lens, {width_px, height_px});
    out.n_coefficients = fit_with_possible_coefficients(fit, lens, width_px, height_px);
    out.camera = fit.camera();
    out.sigma = fit.sigma();
    out.rms_px = fit.rms_px();
    out.corner_sigma_px = fit.corner_sigma_px();
    out.condition = fit.condition();
    for (std::size_t i = 0; i < views.size(); ++i) {
      out.residual_px.push_back(fit.residuals(i));
      double sum = 0.0;
      for (const Vector2& r : out.residual_px.back()) sum += r.u * r.u + r.v * r.v;
      out.view_rms_px.push_back(std::sqrt(sum / static_cast<double>(board.n_corners())));
      const double cosine = std::min(1.0, std::abs(fit.pose(i).rotation(2, 2)));
      out.tilt_deg.push_back(std::acos(cosine) * 180.0 / std::numbers::pi);
    }
  } catch (const cv::Exception&) {
    throw std::runtime_error(
        "calibration: these views do not determine the camera; film the board tilted by 20 to 40 degrees to all "
        "sides, at different places and distances");
  }
  const bool sound = std::isfinite(out.rms_px) && out.camera.fx > 0.0 && out.camera.fy > 0.0 &&
                     std::all_of(out.sigma.begin(), out.sigma.end(), [](double s) { return std::isfinite(s); });
  if (!sound) {
    throw std::runtime_error(
        "calibration: the fit did not converge; film the board tilted by 20 to 40 degrees to all "
        "sides, and check the number of inner corners");
  }
  return out;
}

std::vector<std::size_t> spread_views(const ChessBoard& board, const std::vector<BoardView>& views, int width_px,
                                      int height_px, std::size_t most) {
  constexpr double kLeastDistance = 0.05;
  std::vector<std::vector<double>> looks;
  for (const BoardView& view : views) looks.push_back(look_of(board, view, width_px, height_px));
  std::vector<double> gap(views.size(), 1e9);  // distance to the nearest chosen view; the largest board is chosen first
  for (std::size_t i = 0; i < views.size(); ++i) gap[i] += looks[i][2];
  std::vector<std::size_t> chosen;
  while (chosen.size() < most && !gap.empty()) {
    const auto next = static_cast<std::size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
    if (!(gap[next] >= kLeastDistance)) break;
    chosen.push_back(next);
    for (std::size_t i = 0; i < gap.size(); ++i) gap[i] = std::min(gap[i], distance(looks[i], looks[next]));
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace core
