// The whole pipeline under load, with frames in memory. Prints lines of "name<TAB>value"; exit code 1 where a condition
// is violated.
//   overload_run overload SECONDS          a source four times faster than tracking can follow, in real time
//   overload_run loss SECONDS [SEGMENT]    30 % of the frames lost at random before they reach the service
//   overload_run soak FRAMES               as fast as possible
//   overload_run latency SECONDS CPUS PRIORITY [KEY=VALUE]...   1920 x 1080 at 60 frames a second, CPUS kept busy,
//                                                  SCHED_FIFO PRIORITY, and whatever else the configuration says
// Before these words: --seed N, from which scene and losses are drawn (default 1).
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "rt/clock.h"
#include "tests/support/memory_camera.h"
#include "tests/support/pipeline_run.h"

namespace {

using tests::MemoryCamera;
using tests::Play;
using tests::SceneClip;
constexpr double kMostOff = 0.02;                // of a frequency
constexpr double kMostFrames = 40'000;           // in memory: 5 GB
constexpr std::uint64_t kSettledAfter = 20'000;  // frames of a soak

std::uint64_t resident_bytes() {
  std::uint64_t total = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

struct Run {
  app::Pipeline::Outcome outcome;
  double seconds = 0.0;
  std::uint64_t resident_begin = 0, resident_end = 0;  // after start-up, and the largest until the last frame
};

Run run(const std::shared_ptr<const SceneClip>& clip, const Play& play, double rate_hz,
        const std::vector<std::string>& overrides, std::uint64_t settled_after) {
  const app::AppConfig config = app::parse_config(tests::scene_config(clip->motion), "scene", overrides);
  class Silent : public tests::MemoryPublisher {  // stores nothing
   public:
    bool publish(const core::ModalEstimate&, const std::vector<core::ChannelInfo>&) noexcept override { return true; }
    bool publish(const core::DisplacementSample&, const std::vector<core::ChannelInfo>&) noexcept override {
      return true;
    }
    bool publish(const core::TrackFrame&) noexcept override { return true; }
    bool publish(const core::CpsdSums&, const std::vector<core::ChannelInfo>&) noexcept override { return true; }
    bool publish(const core::Health&) noexcept override { return true; }
  };
  app::Pipeline pipeline(config, std::make_unique<MemoryCamera>(clip, play, rate_hz), std::make_unique<Silent>());
  Run out;
  const std::int64_t begin_ns = rt::monotonic_ns();
  pipeline.start();
  while (pipeline.running()) {
    const std::uint64_t n_processed = pipeline.health().frames_processed;
    if (out.resident_begin == 0 && n_processed >= settled_after)
      out.resident_begin = out.resident_end = resident_bytes();
    if (out.resident_begin != 0 && n_processed < play.n_frames)
      out.resident_end = std::max(out.resident_end, resident_bytes());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  out.outcome = pipeline.join();
  out.seconds = static_cast<double>(rt::monotonic_ns() - begin_ns) * 1e-9;
  return out;
}

// A camera that is faster by this factor also reads out and exposes faster by it.
core::simulation::Scene at_rate(core::simulation::Scene scene, double rate_hz) {
  scene.camera.readout_s *= scene.camera.rate_hz / rate_hz;
  scene.camera.exposure_s *= scene.camera.rate_hz / rate_hz;
  scene.camera.rate_hz = rate_hz;
  return scene;
}

std::shared_ptr<const SceneClip> draw(double seconds, std::uint64_t seed,
                                      double rate_hz = core::simulation::CameraParameters{}.rate_hz) {
  return std::make_shared<const SceneClip>(at_rate(tests::small_scene(seconds, seed), rate_hz),
                                           static_cast<std::uint64_t>(seconds * rate_hz));
}

// Checks the lowest three modes, as far as the kept rate shows them.
bool modes_right(const SceneClip& clip, const core::ModalEstimate& estimate) {
  int n_right = 0, n_visible = 0;
  double worst = 0.0;
  for (const auto& truth : core::simulation::modes_of(clip.motion.scene().structure)) {
    if (truth.frequency_hz > 0.45 * estimate.rate_hz || n_visible == 3) continue;
    ++n_visible;
    double nearest = 1.0;
    for (const core::Mode& mode : estimate.modes) {
      nearest = std::min(nearest, std::abs(mode.frequency_hz / truth.frequency_hz - 1.0));
    }
    n_right += nearest < kMostOff ? 1 : 0;
    if (nearest < kMostOff) worst = std::max(worst, nearest);
  }
  std::printf("modes\t%d of %d within 2 %%, worst of them %.2f %%\n", n_right, n_visible, 100.0 * worst);
  return n_visible > 0 && n_right == n_visible;
}

bool tell(const Run& run) {
  const core::Health& h = run.outcome.health;
  const auto growth = static_cast<double>(run.resident_end - run.resident_begin) * 1e-3;
  std::printf("frames\t%llu in, %llu processed, %llu dropped, %llu missing\n",
              static_cast<unsigned long long>(h.frames_in), static_cast<unsigned long long>(h.frames_processed),
              static_cast<unsigned long long>(h.frames_dropped), static_cast<unsigned long long>(h.frames_missing));
  std::printf("rate\t%.4g Hz\nmemory\t%.0f kB growth\ntime\t%.1f s\n", h.rate_hz, growth, run.seconds);
  return run.outcome.fault.empty() && h.frames_in == h.frames_processed + h.frames_dropped;
}

bool right(const SceneClip& clip, const Run& result) {
  const bool counted = tell(result);
  const bool found = modes_right(clip, result.outcome.estimate);
  return counted && found && result.resident_end - result.resident_begin < 4'000'000;
}

// Frames per second that tracking can process with so many points that it is slower than a camera.
double frames_per_second(const std::vector<std::string>& many_points, std::uint64_t seed) {
  const auto clip = draw(8.0, seed);
  const Play play{clip->frames.size(), 0, true, 0};
  const Run result = run(clip, play, clip->motion.scene().camera.rate_hz, many_points, play.n_frames / 2);
  return static_cast<double>(play.n_frames) / result.seconds;
}

int overload(double seconds, std::uint64_t seed) {
  std::vector<std::string> overrides{"tracking.points_per_region=500", "tracking.min_distance_px=1",
                                     "tracking.corner_quality=0.001", "spectrum.segment=256"};
  const double tracked_hz = frames_per_second(overrides, seed);
  const double rate_hz = std::min(4.0 * tracked_hz, kMostFrames / seconds);
  const auto clip = draw(seconds, seed, rate_hz);
  const Play play{clip->frames.size(), std::llround(1e9 / rate_hz), false, 0};
  std::printf("tracking\t%.0f frames a second\nsource\t%.0f frames a second\n", tracked_hz, rate_hz);
  const Run result = run(clip, play, rate_hz, overrides, play.n_frames / 2);
  return right(*clip, result) && result.outcome.health.frames_dropped > 0 && rate_hz > 3.9 * tracked_hz ? 0 : 1;
}

int loss(double seconds, std::uint64_t seed, const std::string& segment) {
  const auto clip = draw(seconds, seed);
  const Play play{clip->frames.size(), 0, true, seed + 1};
  const Run result =
      run(clip, play, clip->motion.scene().camera.rate_hz, {"spectrum.segment=" + segment}, play.n_frames / 2);
  return right(*clip, result) && result.outcome.health.frames_missing > 0 ? 0 : 1;
}

// An estimate every 512 frames, and freed memory is kept: the process's memory can only grow, and does so until
// identification has had its largest problem.
int soak(std::uint64_t n_frames, std::uint64_t seed) {
  const auto clip = draw(6.0, seed);
  const Run result = run(clip, {n_frames, 0, true, 0}, core::simulation::CameraParameters{}.rate_hz,
                         {"spectrum.segment=256", "identification.period=4", "rt.lock_memory=true"}, kSettledAfter);
  const bool counted = tell(result);
  return counted && result.outcome.health.frames_processed == n_frames && result.resident_end == result.resident_begin
             ? 0
             : 1;
}

int latency(double seconds, std::uint64_t seed, int n_busy, const std::string& priority,
            const std::vector<std::string>& more) {
  const auto clip = std::make_shared<const SceneClip>(at_rate(core::simulation::make_paper_scene(seed, 1.0), 60.0), 30);
  std::atomic<bool> stop{false};
  std::vector<std::thread> busy;
  for (int i = 0; i < n_busy; ++i) {
    busy.emplace_back([&stop] {
      while (!stop.load(std::memory_order_relaxed)) {
      }
    });
  }
  const auto n_frames = static_cast<std::uint64_t>(60.0 * seconds);
  std::vector<std::string> overrides{"spectrum.segment=64", "rt.priority=" + priority, "rt.lock_memory=true"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  const Run result = run(clip, {n_frames, 16'666'667, false, 0}, 60.0, overrides, n_frames / 2);
  stop = true;
  for (std::thread& thread : busy) thread.join();
  const core::LatencyHealth& l = result.outcome.health.frame_latency;
  const auto ms = [](std::uint64_t ns) { return static_cast<double>(ns) * 1e-6; };
  std::printf("p50\t%.2f ms\np99\t%.2f ms\np99.9\t%.2f ms\nworst\t%.2f ms\n", ms(l.p50_ns), ms(l.p99_ns), ms(l.p999_ns),
              ms(l.max_ns));
  for (const std::string& words : result.outcome.estimate.amendments) std::printf("corrected\t%s\n", words.c_str());
  for (const std::string& warning : result.outcome.health.warnings) std::fprintf(stderr, "%s\n", warning.c_str());
  const bool counted = tell(result);
  return counted && (n_busy > 0 || result.outcome.health.frames_dropped == 0) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  std::uint64_t seed = 1;
  if (words.size() > 1 && words[0] == "--seed") {
    seed = std::strtoull(words[1].c_str(), nullptr, 10);
    words.erase(words.begin(), words.begin() + 2);
  }
  const std::string what = words.size() > 1 ? words[0] : "";
  const double amount = words.size() > 1 ? std::atof(words[1].c_str()) : 0.0;
  const auto word = [&](std::size_t i, const char* otherwise) { return i < words.size() ? words[i] : otherwise; };
  if (what == "overload") return overload(amount, seed);
  if (what == "loss") return loss(amount, seed, word(2, "512"));
  if (what == "soak") return soak(static_cast<std::uint64_t>(amount), seed);
  if (what == "latency") {
    const auto n_first = static_cast<std::ptrdiff_t>(std::min<std::size_t>(words.size(), 4));
    return latency(amount, seed, std::atoi(word(2, "0").c_str()), word(3, "0"), {words.begin() + n_first, words.end()});
  }
  std::fprintf(stderr, "usage: overload_run [--seed N] overload|loss|latency SECONDS, or soak FRAMES\n");
  return 2;
}
