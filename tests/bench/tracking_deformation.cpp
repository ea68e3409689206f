// Error of tracked points in deformed images: rendered frames of the paper's building with a camera that
// approaches and recedes by centimetres, each point compared with its true track. Per point and axis, the error about
// its mean is fitted by a constant times the true magnification minus one, and one times the true roll (both of the
// image at that point). Lines of tab-separated values, one for the plates and one for the background:
//   WHAT  POINTS  ERROR_PX  PER_MAGNIFICATION_PX  PER_ROLL_PX  LEFT_PX  STATED/LEFT  SEEN  MAGNIFICATION_RMS
// ERROR_PX, LEFT_PX: rms over points, axes and frames, before and after that fit. STATED: rms of the stated sigma.
//   tracking_deformation [SECONDS] [SEED] [IMAGE_HEIGHT] [Z_RMS_MM] [NOISE]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "core/simulation/presets.h"
#include "core/simulation/render/renderer.h"
#include "core/simulation/scene_motion.h"
#include "core/tracking/structure_tracker.h"

namespace {

using core::simulation::ImagePoint;
using core::simulation::PlanePoint;
constexpr double kInlier_px = 1.0;  // instead of the outlier rejection
constexpr double kApart_px = 8.0;   // distance of the two points that determine the true magnification and roll

// Least squares of one axis of one point on (1, magnification - 1, roll).
class Fit {
 public:
  void add(double error, double zoom, double roll) {
    const std::array<double, 4> row{1.0, zoom, roll, error};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) a_[i][j] += row[i] * row[j];
  }
  void solve() {
    before = a_[3][3] - a_[0][3] * a_[0][3] / std::max(1.0, a_[0][0]);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = k + 1; i < 4 && a_[k][k] > 1e-12; ++i)
        for (std::size_t j = 3; j + 1 > k; --j) a_[i][j] -= a_[i][k] * a_[k][j] / a_[k][k];
    per_roll = a_[2][2] > 1e-12 ? a_[2][3] / a_[2][2] : 0.0;
    per_zoom = a_[1][1] > 1e-12 ? (a_[1][3] - a_[1][2] * per_roll) / a_[1][1] : 0.0;
    after = a_[3][3];
    n = a_[0][0];
  }
  double n = 0.0, before = 0.0, after = 0.0, per_zoom = 0.0, per_roll = 0.0;

 private:
  std::array<std::array<double, 4>, 4> a_{};
};

struct Point {
  int body = 0;
  PlanePoint at, beside;
  Fit u, v;
  double stated2 = 0.0, zoom2 = 0.0;
};

class Run {
 public:
  explicit Run(const core::simulation::Scene& scene) : motion_(scene), renderer_(scene) {
    const auto& camera = motion_.scene().camera;
    frame_.width_px = camera.width_px, frame_.height_px = camera.height_px;
    frame_.pixels.resize(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
    core::StructureTrackerConfig config;
    double plate_px = 1e9;
    for (const auto& plate : motion_.scene().plates)
      plate_px = std::min(plate_px, std::min(plate.width_mm, plate.height_mm) * camera.alpha_px / plate.z_mm);
    config.klt.window_px = std::min(21, static_cast<int>(0.25 * plate_px) * 2 + 1);
    config.seed.min_distance_px = std::max(2, config.klt.window_px / 3);
    std::vector<int> body_of_region;
    for (const auto& [body, region] : core::simulation::tracking_regions(motion_))
      config.regions.push_back(region), body_of_region.push_back(body);
    tracker_ = std::make_unique<core::StructureTracker>(config);
    draw(0);
    if (const std::string error = tracker_->seed(frame_); !error.empty()) throw std::runtime_error(error);
    tracks_.points.resize(tracker_->n_points());
    points_.resize(tracker_->n_points());
    (void)tracker_->track(frame_, tracks_);
    keyframe_ = tracks_;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const core::TrackPoint& seen = keyframe_.points[i];
      Point& point = points_[i];
      point.body = body_of_region[seen.region];
      point.at = motion_.material_point(point.body, {seen.u_px, seen.v_px}, 0.0);
      point.beside = motion_.material_point(point.body, {seen.u_px + kApart_px, seen.v_px}, 0.0);
    }
  }

  void add(std::uint64_t k) {
    draw(k);
    (void)tracker_->track(frame_, tracks_);
    const double t_s = static_cast<double>(k) / motion_.scene().camera.rate_hz;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Point& point = points_[i];
      core::TrackPoint& found = tracks_.points[i];
      const ImagePoint from = motion_.see(point.body, point.at, 0.0), to = motion_.see(point.body, point.at, t_s);
      const ImagePoint beside = motion_.see(point.body, point.beside, t_s);
      const double zoom = (beside.u_px - to.u_px) / kApart_px - 1.0, roll = (beside.v_px - to.v_px) / kApart_px;
      const double u = found.u_px - keyframe_.points[i].u_px - (to.u_px - from.u_px);
      const double v = found.v_px - keyframe_.points[i].v_px - (to.v_px - from.v_px);
      found.inlier = found.seen && std::abs(u) < kInlier_px && std::abs(v) < kInlier_px;
      if (!found.inlier) continue;
      point.u.add(u, zoom, roll), point.v.add(v, zoom, roll);
      point.stated2 += found.sigma_px * found.sigma_px, point.zoom2 += zoom * zoom;
    }
    tracker_->learn(tracks_);
    ++n_frames_;
  }

  void print() {
    for (Point& point : points_) point.u.solve(), point.v.solve();
    print("plates", false);
    print("background", true);
  }

 private:
  void draw(std::uint64_t k) {
    renderer_.render(k, frame_.pixels.data());
    frame_.sequence = k;
    frame_.t_start_ns = std::llround(1e9 * static_cast<double>(k) / motion_.scene().camera.rate_hz);
  }
  void print(const char* what, bool is_background) const {
    double n = 0.0, before = 0.0, after = 0.0, stated2 = 0.0, zoom2 = 0.0, per_zoom = 0.0, per_roll = 0.0, count = 0.0;
    for (const Point& point : points_) {
      if ((point.body == core::simulation::kBackgroundBody) != is_background) continue;
      count += 1.0;
      for (const Fit* fit : {&point.u, &point.v}) {
        n += fit->n, before += fit->before, after += fit->after;
        per_zoom += fit->per_zoom * fit->per_zoom, per_roll += fit->per_roll * fit->per_roll;
      }
      stated2 += 2.0 * point.stated2, zoom2 += 2.0 * point.zoom2;
    }
    if (count == 0.0 || n == 0.0) return;
    std::printf("%s\t%.0f\t%.5f\t%.4f\t%.4f\t%.5f\t%.3f\t%.4f\t%.5f\n", what, count, std::sqrt(before / n),
                std::sqrt(per_zoom / (2.0 * count)), std::sqrt(per_roll / (2.0 * count)), std::sqrt(after / n),
                std::sqrt(stated2 / after), n / (2.0 * count * n_frames_), std::sqrt(zoom2 / n));
  }

  core::simulation::SceneMotion motion_;
  core::simulation::Renderer renderer_;
  core::Frame frame_;
  std::unique_ptr<core::StructureTracker> tracker_;
  core::TrackFrame tracks_, keyframe_;
  std::vector<Point> points_;
  double n_frames_ = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 20.0;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  core::simulation::Scene scene = core::simulation::make_paper_scene(seed, seconds);
  const int height = argc > 3 ? std::atoi(argv[3]) : 1080;
  core::simulation::set_image_size(scene, height * 16 / 9, height);
  if (argc > 4) scene.hover.z_rms_mm = std::atof(argv[4]);
  if (argc > 5) scene.camera.noise_sigma = std::atof(argv[5]);
  Run run(scene);
  for (std::uint64_t k = 1; k < static_cast<std::uint64_t>(seconds * scene.camera.rate_hz); ++k) run.add(k);
  run.print();
}
