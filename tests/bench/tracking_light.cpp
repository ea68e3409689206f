// Influence of changing light on tracks and modes: a rendered clip without changes, under flickering lamps, and with
// a shadow's edge that moves over the picture, each through the whole service. For comparison OpenCV's tracker on the
// same frames and points, started at the true position. Tab-separated lines:
//   LIGHT  OURS_PX  OPENCV_PX  REGIONS_PX  SEEN  MODES  FALSE_MODES  WORST_PERCENT
// rms over points and axes: ours of the inliers; REGIONS_PX: of the regions' mean motion, from
// which displacements are computed; SEEN: share of inliers. MODES: true ones found, FALSE_MODES: structural
// poles that are no modes.
//   tracking_light [SECONDS] [SEED]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <opencv2/video/tracking.hpp>
#include <string>

#include "core/simulation/random_stream.h"
#include "tests/support/pipeline_run.h"

namespace {

using core::simulation::SceneMotion;
using tests::SceneClip;

constexpr double kFlickerDepth = 0.1, kFlickerHz = 7.0;
constexpr double kShadowDepth = 0.4, kShadowEdgePx = 4.0, kShadowCrossing_s = 20.0;
constexpr double kNearPercent = 2.0;  // of a frequency: it is that mode
constexpr int kWindow_px = 13;

enum class Disturbance : std::uint8_t { kNone, kFlicker, kShadow, kDimmed };

// Relative brightness at column u: the edge moves over the picture and back.
double shade(Disturbance light, double t_s, double u, int width_px) {
  if (light == Disturbance::kDimmed) return std::fmod(t_s, 2.0) < 1.0 ? 1.0 : 1.0 - kShadowDepth;
  if (light != Disturbance::kShadow) return 1.0;
  const double turns = t_s / kShadowCrossing_s, phase = turns - 2.0 * std::floor(0.5 * turns);
  const double edge = width_px * (phase < 1.0 ? phase : 2.0 - phase);
  return 1.0 - kShadowDepth / (1.0 + std::exp((u - edge) / kShadowEdgePx));
}

// The scene's light without noise, shaded, then converted as by a sensor.
std::shared_ptr<const SceneClip> draw(core::simulation::Scene scene, Disturbance light, std::uint64_t n_frames) {
  if (light == Disturbance::kFlicker) scene.light.flicker_depth = kFlickerDepth, scene.light.flicker_hz = kFlickerHz;
  auto clip = std::make_shared<SceneClip>(scene, 0);
  const core::simulation::Renderer renderer(clip->motion.scene());
  const int width = scene.camera.width_px, height = scene.camera.height_px;
  const auto n_pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<float> grey(n_pixels);
  for (std::uint64_t k = 0; k < n_frames; ++k) {
    const double t_s = static_cast<double>(k) / scene.camera.rate_hz;
    renderer.render_light(k, grey.data());
    core::simulation::RandomStream noise(scene.seed, "light_noise", k);
    std::vector<std::uint8_t>& pixels = clip->frames.emplace_back(n_pixels);
    for (std::size_t i = 0; i < n_pixels; ++i) {
      const double u = static_cast<double>(i % static_cast<std::size_t>(width));
      const double value =
          shade(light, t_s, u, width) * static_cast<double>(grey[i]) + scene.camera.noise_sigma * noise.gaussian();
      pixels[i] = static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
    }
  }
  return clip;
}

class Rms {
 public:
  void add(double u, double v) { sum_ += u * u + v * v, n_ += 2; }
  [[nodiscard]] double value() const { return n_ > 0 ? std::sqrt(sum_ / n_) : 0.0; }

 private:
  double sum_ = 0.0, n_ = 0.0;
};

// True positions of the first frame's points in another frame, and the errors of both trackers there.
class Judge {
 public:
  Judge(const SceneClip& clip, const core::TrackFrame& keyframe) : clip_(clip), keyframe_(keyframe) {
    const auto marked = core::simulation::tracking_regions(clip.motion);
    for (const core::TrackPoint& point : keyframe.points) {
      body_.push_back(marked[point.region].body);
      material_.push_back(clip.motion.material_point(body_.back(), {point.u_px, point.v_px}, 0.0));
      origin_.push_back(clip.motion.see(body_.back(), material_.back(), 0.0));
      from_.emplace_back(static_cast<float>(point.u_px), static_cast<float>(point.v_px));
    }
    n_regions_ = marked.size();
  }

  void add(const core::TrackFrame& frame) {
    const std::size_t n = keyframe_.points.size();
    std::vector<core::Vector2> sum(n_regions_);
    std::vector<int> count(n_regions_);
    std::vector<core::Vector2> motion(n);
    const double t_s = static_cast<double>(frame.sequence) / clip_.motion.scene().camera.rate_hz;
    for (std::size_t i = 0; i < n; ++i) {
      const auto place = clip_.motion.see(body_[i], material_[i], t_s);
      motion[i] = {place.u_px - origin_[i].u_px, place.v_px - origin_[i].v_px};
      const core::TrackPoint& point = frame.points[i];
      const double du = point.u_px - keyframe_.points[i].u_px - motion[i].u;
      const double dv = point.v_px - keyframe_.points[i].v_px - motion[i].v;
      if (!point.inlier) continue;
      ours.add(du, dv);
      sum[point.region].u += du, sum[point.region].v += dv;
      ++count[point.region], ++n_inliers;
    }
    for (std::size_t r = 0; r < n_regions_; ++r)
      if (count[r] > 0) regions.add(sum[r].u / count[r], sum[r].v / count[r]);
    n_points += static_cast<double>(n);
    add_theirs(frame.sequence, motion);
  }

  Rms ours, theirs, regions;
  double n_inliers = 0.0, n_points = 0.0;

 private:
  void add_theirs(std::uint64_t sequence, const std::vector<core::Vector2>& motion) {
    const auto& camera = clip_.motion.scene().camera;
    const auto image = [&](std::uint64_t k) {
      return cv::Mat(camera.height_px, camera.width_px, CV_8UC1, const_cast<std::uint8_t*>(clip_.frames[k].data()));
    };
    std::vector<cv::Point2f> to;
    for (std::size_t i = 0; i < motion.size(); ++i)
      to.emplace_back(from_[i].x + static_cast<float>(std::round(motion[i].u)),
                      from_[i].y + static_cast<float>(std::round(motion[i].v)));
    std::vector<unsigned char> status;
    std::vector<float> residual;
    cv::calcOpticalFlowPyrLK(image(0), image(sequence), from_, to, status, residual, {kWindow_px, kWindow_px}, 1,
                             {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.001},
                             cv::OPTFLOW_USE_INITIAL_FLOW);
    for (std::size_t i = 0; i < motion.size(); ++i)
      if (status[i] != 0)
        theirs.add(static_cast<double>(to[i].x - from_[i].x) - motion[i].u,
                   static_cast<double>(to[i].y - from_[i].y) - motion[i].v);
  }

  const SceneClip& clip_;
  const core::TrackFrame& keyframe_;
  std::vector<int> body_;
  std::vector<core::simulation::PlanePoint> material_;
  std::vector<core::simulation::ImagePoint> origin_;
  std::vector<cv::Point2f> from_;
  std::size_t n_regions_ = 0;
};

void judge(const char* name, Disturbance light, double seconds, std::uint64_t seed) {
  const core::simulation::Scene scene = tests::small_scene(seconds, seed);
  const auto n_frames = static_cast<std::uint64_t>(seconds * scene.camera.rate_hz);
  const auto clip = draw(scene, light, n_frames);
  tests::CameraScript script;
  script.n_frames = n_frames;
  auto heard = std::make_shared<tests::Heard>();
  core::ModalEstimate estimate;
  {
    const app::AppConfig config = app::parse_config(
        tests::scene_config(clip->motion), "scene",
        {"spectrum.segment=512", "telemetry.tracks_every=1", "tracking.window_px=" + std::to_string(kWindow_px)});
    app::Pipeline pipeline(config, std::make_unique<tests::ScriptedCamera>(clip, script),
                           std::make_unique<tests::TellingPublisher>(heard));
    pipeline.start();
    (void)tests::runs_to_its_end(pipeline, std::chrono::hours(1));
    estimate = pipeline.join().estimate;
  }
  Judge errors(*clip, heard->tracks.front());
  for (std::size_t k = 1; k < heard->tracks.size(); ++k) errors.add(heard->tracks[k]);
  int n_found = 0, n_false = 0;
  double worst = 0.0;
  const auto truth = core::simulation::modes_of(scene.structure);
  for (const core::Mode& mode : estimate.modes) {
    if (mode.verdict != core::Verdict::kStructural) continue;
    double nearest = HUGE_VAL;
    for (const auto& true_mode : truth)
      nearest = std::min(nearest, 100.0 * std::abs(mode.frequency_hz / true_mode.frequency_hz - 1.0));
    (nearest < kNearPercent ? n_found : n_false) += 1;
    if (nearest < kNearPercent) worst = std::max(worst, nearest);
  }
  std::printf("%s\t%.5f\t%.5f\t%.5f\t%.4f\t%d\t%d\t%.3f\n", name, errors.ours.value(), errors.theirs.value(),
              errors.regions.value(), errors.n_inliers / errors.n_points, n_found, n_false, worst);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  const double seconds = argc > 1 ? std::atof(argv[1]) : 60.0;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  judge("steady", Disturbance::kNone, seconds, seed);
  judge("flicker", Disturbance::kFlicker, seconds, seed);
  judge("shadow", Disturbance::kShadow, seconds, seed);
  judge("dimmed", Disturbance::kDimmed, seconds, seed);
}
