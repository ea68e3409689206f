// Captures through a driver and prints one fact per line ("name<TAB>value") for a script: frames, gaps,
// numbers, times, handling of faults, and, given the frames that were sent, whether each one arrived unchanged.
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/camera/camera_factory.h"
#include "tests/support/numbered_picture.h"

namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  drivers::CameraOptions camera;
  std::string sent;       // raw gray frames; empty = not compared
  long n_frames = 30;     // per run
  double limit_s = 20;    // per run
  int n_runs = 1;         // start ... stop
  int priority = 0;       // SCHED_FIFO, memory locked; 0 = ordinary
  bool numbered = false;  // pictures carry their numbers (tests/support/numbered_picture.h)
};

struct Tally {
  long n_frames = 0, n_gaps = 0, n_missing = 0, n_timeouts = 0;
  long n_unchanged = 0, n_in_order = 0;  // equal to a sent frame; next to the previous one, by the numbers
  std::uint64_t first = 0, last = 0;
  double first_s = 0, last_s = 0, worst_step = 0;  // frames: the largest deviation of a step from its number's
  std::vector<double> ages_ms;                     // from a frame's stamp until its delivery
  long early_kib = 0, early_files = 0;             // used after the first frames
  drivers::CaptureStatus end = drivers::CaptureStatus::kFrame;
  long n_damaged_pictures = 0, n_wrong_numbers = 0, n_restarts = 0;  // numbered ones: steps unlike the sequence's
  std::optional<unsigned> number;                                    // of the last one
};

volatile std::sig_atomic_t stop_asked = 0;

// Anonymous memory of this process: pages of library code are excluded, because they are no leak. Counted page by page,
// unlike the kernel's running counts, which lag by some hundred KiB per thread.
long anonymous_kib() {
  std::ifstream sums("/proc/self/smaps_rollup");
  for (std::string key; sums >> key;) {
    if (long kib = 0; key == "Anonymous:" && sums >> kib) return kib;
  }
  return -1;
}
long open_files() { return static_cast<long>(std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {})); }

class Sent {
 public:
  Sent(const std::string& path, std::size_t frame_bytes) : frame_bytes_(frame_bytes) {
    if (path.empty()) return;
    std::ifstream file(path, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
  }
  [[nodiscard]] long count() const { return static_cast<long>(bytes_.size() / frame_bytes_); }
  // Index of the sent frame; -1: none.
  [[nodiscard]] long find(const std::vector<std::uint8_t>& pixels, long guess) const {
    for (long i = 0; i < count(); ++i) {
      const long at = (guess + i) % count();
      if (std::memcmp(bytes_.data() + static_cast<std::size_t>(at) * frame_bytes_, pixels.data(), frame_bytes_) == 0)
        return at;
    }
    return -1;
  }

 private:
  std::size_t frame_bytes_;
  std::vector<char> bytes_;
};

// A smaller number than before is a sender that has started again.
void check_number(const core::Frame& frame, long advance, Tally& tally) {
  const auto number = test_support::number_in(frame);
  tally.n_damaged_pictures += number ? 0 : 1;
  if (number && tally.number) {
    const long step = static_cast<long>(*number) - static_cast<long>(*tally.number);
    tally.n_restarts += step < 0 ? 1 : 0;
    tally.n_wrong_numbers += step >= 0 && step != advance ? 1 : 0;
  }
  if (number) tally.number = number;
}

void run(drivers::Camera& camera, const Arguments& arguments, const Sent& sent, Tally& tally) {
  const core::CameraInfo info = camera.info();
  core::Frame frame;
  frame.pixels.resize(static_cast<std::size_t>(info.width_px) * static_cast<std::size_t>(info.height_px));
  camera.start();
  const auto limit = Clock::now() + std::chrono::duration<double>(arguments.limit_s);
  long in_this_run = 0, image = -1;
  while (stop_asked == 0 && in_this_run < arguments.n_frames && Clock::now() < limit) {
    tally.end = camera.capture(frame, std::chrono::milliseconds(200));
    if (tally.end == drivers::CaptureStatus::kTimeout) {
      ++tally.n_timeouts;
      continue;
    }
    if (tally.end != drivers::CaptureStatus::kFrame) break;
    const double now_s = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
    const double t_s = 1e-9 * static_cast<double>(frame.t_start_ns);
    long advance = 1;
    if (in_this_run++ == 0) {
      tally.first = frame.sequence;
      tally.first_s = t_s;
    } else {
      advance = static_cast<long>(frame.sequence - tally.last);
      tally.n_missing += advance - 1;
      tally.worst_step =
          std::max(tally.worst_step, std::abs((t_s - tally.last_s) * info.rate_hz - static_cast<double>(advance)));
    }
    tally.n_gaps += frame.gap_before ? 1 : 0;
    tally.last = frame.sequence;
    tally.last_s = t_s;
    tally.ages_ms.push_back(1e3 * (now_s - t_s));
    if (tally.n_frames == 0) std::fprintf(stderr, "streaming\n");  // a script waits for this line
    if (++tally.n_frames == 20 && arguments.priority == 0) {       // counting takes longer than a frame
      tally.early_kib = anonymous_kib();
      tally.early_files = open_files();
    }
    if (arguments.numbered) check_number(frame, advance, tally);
    if (sent.count() == 0) continue;
    const long expected = image < 0 ? 0 : (image + advance) % sent.count();
    const long found = sent.find(frame.pixels, expected);
    tally.n_unchanged += found >= 0 ? 1 : 0;
    tally.n_in_order += found >= 0 && (image < 0 || found == expected) ? 1 : 0;
    image = found;
  }
  camera.stop();
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void take_priority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0 || sched_setscheduler(0, SCHED_FIFO, &parameters) != 0)
    throw std::runtime_error("the priority was refused: run it as root");
}

void print(const drivers::Camera& camera, const Tally& tally) {
  const core::CameraInfo info = camera.info();
  const drivers::DeviceTrouble trouble = camera.trouble();
  std::printf("camera\t%s\n", info.description.c_str());
  std::printf("frames\t%ld\ngaps\t%ld\nmissing\t%ld\ntimeouts\t%ld\n", tally.n_frames, tally.n_gaps, tally.n_missing,
              tally.n_timeouts);
  std::printf("span\t%ld\n", static_cast<long>(tally.last - tally.first) + 1);
  std::printf("span_by_time\t%.0f\n", 1.0 + (tally.last_s - tally.first_s) * info.rate_hz);
  std::printf("rate_hz\t%.3f\n", tally.last > tally.first
                                     ? static_cast<double>(tally.last - tally.first) / (tally.last_s - tally.first_s)
                                     : 0.0);
  std::printf("worst_step_frames\t%.3f\nage_p50_ms\t%.3f\nage_p99_ms\t%.3f\nworst_age_ms\t%.3f\n", tally.worst_step,
              percentile(tally.ages_ms, 0.5), percentile(tally.ages_ms, 0.99), percentile(tally.ages_ms, 1.0));
  std::printf("damaged_pictures\t%ld\nwrong_numbers\t%ld\nrestarts\t%ld\n", tally.n_damaged_pictures,
              tally.n_wrong_numbers, tally.n_restarts);
  std::printf("unchanged\t%ld\nin_order\t%ld\n", tally.n_unchanged, tally.n_in_order);
  std::printf("lost\t%d\ninterruptions\t%llu\ndamaged\t%llu\nno_clock\t%d\n", trouble.is_lost ? 1 : 0,
              static_cast<unsigned long long>(trouble.n_interruptions),
              static_cast<unsigned long long>(trouble.n_damaged), trouble.has_no_clock ? 1 : 0);
  std::printf("growth_kib\t%ld\ngrowth_files\t%ld\n", anonymous_kib() - tally.early_kib,
              open_files() - tally.early_files);
  std::printf("exposure_ms\t%.2f\nend\t%d\nfault\t%s\n", 1e-6 * static_cast<double>(info.exposure_ns),
              static_cast<int>(tally.end), camera.fault().c_str());
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  const std::map<std::string, drivers::CameraKind> kinds{{"v4l2", drivers::CameraKind::kV4l2},
                                                         {"libcamera", drivers::CameraKind::kLibcamera},
                                                         {"stream", drivers::CameraKind::kStream}};
  std::string driver = "v4l2", size;
  bool is_udp = false;
  CLI::App app("Captures through one of the drivers and prints what came.");
  app.add_option("--driver", driver, "v4l2, libcamera or stream")
      ->check(CLI::IsMember({"v4l2", "libcamera", "stream"}))
      ->capture_default_str();
  app.add_option("--source", arguments.camera.source, "node or name; default: the only camera");
  app.add_option("--size", size, "WIDTHxHEIGHT");
  app.add_option("--format", arguments.camera.format, "pixel format");
  app.add_option("--rate", arguments.camera.rate_hz, "frames a second");
  app.add_option("--exposure", arguments.camera.exposure_ms, "ms");
  app.add_option("--frames", arguments.n_frames, "to take in each run")->capture_default_str();
  app.add_option("--limit", arguments.limit_s, "seconds a run may take")->capture_default_str();
  app.add_option("--runs", arguments.n_runs, "start ... stop, so often")->capture_default_str();
  app.add_option("--fifo", arguments.priority, "SCHED_FIFO priority, with memory locked; default: ordinary");
  app.add_flag("--udp", is_udp, "stream: RTSP's pictures beside its connection");
  app.add_flag("--numbered", arguments.numbered, "pictures carry their numbers");
  app.add_option("--sent", arguments.sent, "the gray frames that the camera sends, to compare with");
  CLI11_PARSE(app, argc, argv);
  if (is_udp) arguments.camera.transport = drivers::StreamTransport::kUdp;
  prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);  // the kernel would merge pages into huge ones at arbitrary times
  struct sigaction action {};
  action.sa_handler = [](int) { stop_asked = 1; };
  sigaction(SIGINT, &action, nullptr);
  arguments.camera.kind = kinds.at(driver);
  if (!size.empty() &&
      std::sscanf(size.c_str(), "%dx%d", &arguments.camera.width_px, &arguments.camera.height_px) != 2) {
    std::fprintf(stderr, "--size %s: write WIDTHxHEIGHT\n", size.c_str());
    return 2;
  }
  try {
    const auto camera = drivers::make_camera(arguments.camera);
    const core::CameraInfo info = camera->info();
    const Sent sent(arguments.sent, static_cast<std::size_t>(info.width_px) * static_cast<std::size_t>(info.height_px));
    Tally tally;
    tally.ages_ms.reserve(static_cast<std::size_t>(std::min(arguments.n_frames, 1000000L)));
    if (arguments.priority > 0) take_priority(arguments.priority);
    for (int i = 0; i < arguments.n_runs; ++i) run(*camera, arguments, sent, tally);
    print(*camera, tally);
  } catch (const std::exception& thrown) {
    std::printf("error\t%s\n", thrown.what());
    return 1;
  }
  return 0;
}
