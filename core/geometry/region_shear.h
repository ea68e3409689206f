#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/point_correction.h"
#include "core/geometry/rolling_shutter.h"
#include "core/types/track.h"

namespace core {

// Shear of the image of each region along the readout, frame by frame, and the motion that causes it. Rows are read
// one after the other: in a region that moves at v_j px per frame, a point at readout fraction g_j (0 .. 1 over the
// image) is seen rho g_j v_j from its position at the start of the frame, rho the readout time in frames. Fitted to
// the motion of the points since the keyframe by weighted least squares, (x, y) and g_j about the region's weighted
// means:
//     d_j = mean + turn (y, -x) + growth (x, y) + shear g_j      per region, both image axes, pixels
//           + pitch (x y, y^2) + yaw (x^2, x y)                  of the whole image, also about the regions' means
// Turn (rotation) and growth are free per region: floors tilt, depths differ. Pitch and yaw are the camera's: their
// linear part shears regions off the image centre, which must not be mistaken for a readout.
//
// The shear is rho times the rate of `carrier`: the mean, and a constant linear map of turn and growth, because g_j
// times a rotating or growing field is quadratic and resembles pitch and yaw. The keyframe's errors are constants in
// both.
//
// One thread; does not allocate after construction.
class RegionShear {
 public:
  static constexpr std::size_t kAxes = 2;  // u, v

  struct Config {
    std::size_t n_regions = 0;
    CameraModel camera;           // points are undistorted; without calibration: relative to the image centre
    ReadoutModel readout;         // direction and image size; its time is not used
    PointCorrection places = {};  // corrections in addition to the camera
    // Extent along the readout below which a region's shear carries no information: a video codec gives each of its
    // blocks one motion, so that regions no larger than a few blocks lose their shear.
    double least_extent_px = 0.0;
  };
  // keyframe: contains every later point; points that are lost or not finite there are excluded. Throws
  // std::invalid_argument: a point without a region.
  RegionShear(const Config& config, const TrackFrame& keyframe);

  [[nodiscard]] std::size_t n_regions() const noexcept { return regions_.size(); }
  // Number of regions whose points spread enough to distinguish shear from turn and growth, and over the least extent.
  [[nodiscard]] std::size_t n_usable() const noexcept;

  struct Sample {                              // one frame, per region and axis: [2 region + axis]
    std::vector<double> carrier_px, shear_px;  // shear: from fraction 0 to 1, for the region's size in the keyframe
    std::vector<std::uint8_t> seen;            // per region
  };
  [[nodiscard]] Sample sample_prototype() const;
  // Lost points, outliers and NaN are excluded; a region with too few remaining points is not seen.
  void fit(const TrackFrame& tracks, Sample& out) noexcept;

  // Fisher information of the shears [2 region + axis] with all points seen, for points of unit variance on average;
  // zero for regions whose shear carries no information.
  [[nodiscard]] const Eigen::MatrixXd& information() const noexcept { return information_; }
  // Covariance of the carriers in the same units.
  [[nodiscard]] const Eigen::MatrixXd& carrier_covariance() const noexcept { return carrier_covariance_; }

 private:
  // Prior of the camera's pitch and yaw, as the motion of the image centre relative to the image's width: bounds them
  // if few points determine them. Wide compared with any flight; relative to points of unit variance (px^2).
  static constexpr double kMostTurn = 0.3;
  // Indices of a region's unknowns, their number, and that with pitch and yaw.
  static constexpr std::size_t kTurn = 2, kShear = 4, kOwn = 6, kAll = 8;
  using Normal = std::array<std::array<double, kAll + 1>, kAll>;  // the last column is the right-hand side

  struct Point {
    Vector2 keyframe;
    double weight = 1.0;
    std::uint16_t region = 0;
    std::array<std::array<double, kAll>, kAxes> column{};
  };
  struct RegionFit {
    std::vector<std::size_t> points;
    double mean_fraction = 0.0;
    double fraction_scale = 1.0;       // the shear column is g / fraction_scale
    std::array<double, kOwn> pivot{};  // of the elimination with all points
    bool usable = false;               // its own unknowns can be distinguished
    bool tells = false;                // its shear carries information
    Normal normal{};
  };

  void place_columns(const Config& config, const TrackFrame& keyframe);
  void centre_columns(RegionFit& region);
  void add_point(const Point& point, Vector2 motion, Normal& normal) const noexcept;
  void judge_regions(double least_fraction);
  void make_information();
  [[nodiscard]] Eigen::MatrixXd covariance() const;
  [[nodiscard]] Eigen::MatrixXd selection(std::size_t from) const;
  [[nodiscard]] Eigen::VectorXd field_response(std::size_t region, std::size_t unknown) const;
  [[nodiscard]] bool accumulate(const TrackFrame& tracks, RegionFit& region) noexcept;

  CameraModel camera_;
  PointCorrection places_;
  bool corrects_places_;
  std::vector<Point> points_;
  std::vector<RegionFit> regions_;
  Eigen::MatrixXd information_, carrier_covariance_;
  Eigen::MatrixXd carrier_;     // pixels of carrier per entry of fields_
  std::vector<double> fields_;  // turn and growth of every region; pitch, yaw
};

}  // namespace core
