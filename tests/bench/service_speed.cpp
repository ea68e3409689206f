// The whole service on one processor, as fast as possible, over frames in memory (1920 x 1080, or of the given height),
// without decoding. Lines of "name<TAB>value": frames per second; of each stage the processor time per frame (us) and
// its share; the same frames and points with OpenCV's tracker, which the service used before (pyramid_klt.h), and the
// resulting frames per second.
//   service_speed [FRAMES] [SEED] [HEIGHT]
#include <sched.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "core/linear/median.h"
#include "core/tracking/pyramid_klt.h"
#include "firmware_app/config/core_config.h"
#include "rt/clock.h"
#include "tests/support/memory_camera.h"
#include "tests/support/pipeline_run.h"

namespace {

constexpr std::size_t kDrawnBytes = 200'000'000;  // of frames
constexpr std::uint64_t kFewest = 60;             // for the median of OpenCV's times
constexpr std::uint64_t kMostOfTheirs = 400;

// All threads of this process, including later ones.
void stay_on_one_cpu() {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  CPU_SET(0, &cpus);
  if (sched_setaffinity(0, sizeof cpus, &cpus) != 0) std::fprintf(stderr, "service_speed: cannot stay on one CPU\n");
}

double their_time_us(const tests::SceneClip& clip, const core::TrackFrame& keyframe, std::uint64_t n_frames) {
  const auto& camera = clip.motion.scene().camera;
  const auto image = [&](std::uint64_t k) {
    return cv::Mat(camera.height_px, camera.width_px, CV_8UC1,
                   const_cast<std::uint8_t*>(tests::played_frame(clip, k).data()));
  };
  core::PyramidKlt tracker({});
  std::vector<cv::Point2f> points;
  for (const core::TrackPoint& p : keyframe.points)
    points.emplace_back(static_cast<float>(p.u_px), static_cast<float>(p.v_px));
  tracker.set_keyframe(image(0), points);
  std::vector<core::TrackedPoint> found;
  std::vector<double> us;
  for (std::uint64_t k = 1; k < std::clamp(n_frames, kFewest, kMostOfTheirs); ++k) {
    const std::int64_t begin_ns = rt::monotonic_ns();
    (void)tracker.track(image(k), points, found);
    us.push_back(static_cast<double>(rt::monotonic_ns() - begin_ns) * 1e-3);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (found[i].seen) points[i] = found[i].position;
  }
  return core::median(std::move(us));
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t n_frames = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 3000;
  stay_on_one_cpu();
  cv::setNumThreads(1);
  core::simulation::Scene scene =
      core::simulation::make_paper_scene(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1, 10.0);
  const int height_px = argc > 3 ? std::atoi(argv[3]) : 1080;
  core::simulation::set_image_size(scene, height_px * 16 / 9, height_px);
  const std::size_t n_drawn = kDrawnBytes / static_cast<std::size_t>(scene.camera.width_px * scene.camera.height_px);
  const auto clip = std::make_shared<const tests::SceneClip>(scene, n_drawn);
  const app::AppConfig config = app::parse_config(tests::scene_config(clip->motion), "scene",
                                                  {"tracking.points_per_region=30", "tracking.window_px=21",
                                                   "tracking.min_distance_px=8", "telemetry.tracks_every=1"});
  auto heard = std::make_shared<tests::Heard>();
  app::Pipeline pipeline(
      config, std::make_unique<tests::MemoryCamera>(clip, tests::Play{n_frames, 0, true, 0}, scene.camera.rate_hz),
      std::make_unique<tests::TellingPublisher>(heard));
  const std::int64_t begin_ns = rt::monotonic_ns();
  pipeline.start();
  while (pipeline.running()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const double frame_us = static_cast<double>(rt::monotonic_ns() - begin_ns) * 1e-3 / static_cast<double>(n_frames);
  const core::Health health = pipeline.join().health;
  double all_us = 0.0, tracking_us = 0.0;
  for (const core::StageHealth& stage : health.stages) all_us += static_cast<double>(stage.cpu_ns) * 1e-3;
  std::printf("rate\t%.0f\n", 1e6 / frame_us);
  for (const core::StageHealth& stage : health.stages) {
    const double us = static_cast<double>(stage.cpu_ns) * 1e-3;
    std::printf("%s\t%.1f\t%.3f\n", stage.name.c_str(), us / static_cast<double>(n_frames), us / all_us);
    if (stage.name == "tracking") tracking_us = us / static_cast<double>(n_frames);
  }
  const std::size_t n_points = config.regions.size() * 30;
  core::TrackFrame keyframe;
  core::StructureTracker tracker(app::tracker_config(config));
  core::Frame first;
  first.width_px = scene.camera.width_px, first.height_px = scene.camera.height_px, first.pixels = clip->frames[0];
  (void)tracker.seed(first);
  keyframe.points.resize(tracker.n_points());
  (void)tracker.track(first, keyframe);
  const double theirs_us = their_time_us(*clip, keyframe, n_frames);
  std::printf("points\t%zu of %zu\nopencv\t%.1f\nrate with it\t%.0f\n", keyframe.points.size(), n_points, theirs_us,
              1e6 / (frame_us - tracking_us + theirs_us));
}
