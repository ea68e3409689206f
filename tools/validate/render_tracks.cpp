#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/video/tracking.hpp>

#include "core/simulation/presets.h"
#include "core/simulation/random_stream.h"
#include "core/simulation/render/renderer.h"
#include "tools/validate/render.h"

namespace tools {
namespace {

using core::simulation::ImagePoint;
using core::simulation::LensParameters;
using core::simulation::PlanePoint;
using core::simulation::Renderer;
using core::simulation::Scene;

constexpr int kWindow_px = 21, kPointsPerPlate = 20;
constexpr double kStartError_px = 1.0;

struct Material {
  int body;
  PlanePoint point;
};

// Points of the plates whose windows contain nothing else in frame 0.
std::vector<Material> chosen_points(const core::simulation::SceneMotion& motion) {
  const Scene& scene = motion.scene();
  core::simulation::RandomStream random(scene.seed, "selftest_points");
  std::vector<Material> points;
  for (int body = 0; body < scene.n_bodies(); ++body) {
    const auto& plate = scene.plates[static_cast<std::size_t>(body)];
    const double margin_mm = (0.5 * kWindow_px + 4.0) * plate.z_mm / scene.camera.alpha_px;
    for (int i = 0; i < kPointsPerPlate; ++i) {
      const double x = (plate.width_mm - 2.0 * margin_mm) * (random.uniform() - 0.5);
      const double y = (plate.height_mm - 2.0 * margin_mm) * (random.uniform() - 0.5);
      points.push_back({body, {x, y}});
    }
  }
  return points;
}

std::vector<cv::Point2f> see(const core::simulation::SceneMotion& motion, const std::vector<Material>& points,
                             double t_frame_s) {
  std::vector<cv::Point2f> seen;
  for (const Material& point : points) {
    const ImagePoint at = motion.see(point.body, point.point, t_frame_s);
    seen.emplace_back(static_cast<float>(at.u_px), static_cast<float>(at.v_px));
  }
  return seen;
}

cv::Mat draw(const Renderer& renderer, std::uint64_t frame, Renderer::Scratch& scratch) {
  cv::Mat image(renderer.scene().camera.height_px, renderer.scene().camera.width_px, CV_8UC1);
  renderer.render(frame, image.ptr<std::uint8_t>(), scratch);
  return image;
}

TrackError check(std::string name, const Scene& scene, int n_frames) {
  TrackError error;
  error.name = std::move(name);
  const Renderer renderer(scene);
  Renderer::Scratch scratch = renderer.make_scratch();
  const cv::Mat first = draw(renderer, 0, scratch);
  const std::vector<Material> points = chosen_points(renderer.motion());
  const std::vector<cv::Point2f> start = see(renderer.motion(), points, 0.0);
  core::simulation::RandomStream random(scene.seed, "selftest_start_error");
  const auto stray = [&random] { return static_cast<float>(kStartError_px * (2.0 * random.uniform() - 1.0)); };
  double sum2 = 0.0, moved2 = 0.0;
  for (int k = 1; k <= n_frames; ++k) {
    const auto frame = static_cast<std::uint64_t>(k) * (scene.n_frames() - 1) / static_cast<std::uint64_t>(n_frames);
    const cv::Mat image = draw(renderer, frame, scratch);
    const auto truth = see(renderer.motion(), points, static_cast<double>(frame) / scene.camera.rate_hz);
    std::vector<cv::Point2f> found;
    for (const cv::Point2f& at : truth) found.emplace_back(at.x + stray(), at.y + stray());
    std::vector<unsigned char> seen;
    std::vector<float> residual;
    cv::calcOpticalFlowPyrLK(first, image, start, found, seen, residual, {kWindow_px, kWindow_px}, 1,
                             {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 0.001},
                             cv::OPTFLOW_USE_INITIAL_FLOW);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      ++error.n_tracks;
      if (seen[i] == 0) {
        ++error.n_lost;
        continue;
      }
      const cv::Point2d miss = cv::Point2d(found[i]) - cv::Point2d(truth[i]);
      const cv::Point2d moved = cv::Point2d(truth[i]) - cv::Point2d(start[i]);
      error.worst_px = std::max({error.worst_px, std::abs(miss.x), std::abs(miss.y)});
      sum2 += miss.dot(miss);
      moved2 += moved.dot(moved);
    }
  }
  const double n = 2.0 * std::max(1, error.n_tracks - error.n_lost);
  error.rms_px = std::sqrt(sum2 / n);
  error.truth_rms_px = std::sqrt(moved2 / n);
  return error;
}

}  // namespace

std::vector<TrackError> check_opencv_tracks(std::uint64_t seed, int n_frames) {
  const Scene paper = core::simulation::make_paper_scene(seed, 60.0);
  Scene turned = paper;
  turned.camera.roll_rad = 0.052;  // 3 degrees
  turned.hover.pitch_rms_rad = turned.hover.yaw_rms_rad = turned.hover.roll_rms_rad = 0.002;
  turned.hover.x_rms_mm = 15.0;
  turned.camera.lens = {LensParameters::Model::kRadialTangential, {-0.05, 0.01, 2e-4, -2e-4, 0.0}};
  Scene left = paper;
  left.camera.readout_direction = core::ReadoutDirection::kLeft;
  return {check("paper", paper, n_frames), check("roll 3 deg, rotation, lens", turned, n_frames),
          check("read to the left", left, n_frames)};
}

}  // namespace tools
