#include "tools/hovermodal/simulate/clip.h"

#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/simulation/camera/frame_timing.h"
#include "drivers/storage/clip_writer.h"
#include "drivers/storage/csv_writer.h"
#include "tools/hovermodal/simulate/progress.h"
#include "tools/hovermodal/simulate/raw_clip.h"

namespace tools {
namespace {

using core::simulation::DeliveredFrame;
using core::simulation::FrameTiming;
using core::simulation::Renderer;

std::vector<DeliveredFrame> delivered_frames(const core::simulation::Scene& scene) {
  FrameTiming timing(scene);
  std::vector<DeliveredFrame> frames;
  for (DeliveredFrame frame; timing.next(frame);) frames.push_back(frame);
  return frames;
}

void write_stamps(const std::string& path, const std::vector<DeliveredFrame>& frames) {
  drivers::CsvWriter csv(path);
  drivers::append_text(csv.buffer(), "frame,t_s");
  csv.buffer().push_back('\n');
  for (std::size_t i = 0; i < frames.size(); ++i) {
    drivers::append_text(csv.buffer(), std::to_string(i));
    csv.buffer().push_back(',');
    drivers::append_seconds(csv.buffer(), std::llround(frames[i].stamp_s * 1e9));
    csv.buffer().push_back('\n');
    csv.end_line();
  }
  csv.commit();
}

// Delivered frames are rendered by several threads and returned in order. Frame k uses slot k % n_slots; a worker may
// render it once frame k - n_slots has been given back.
class FrameFarm {
 public:
  FrameFarm(const Renderer& renderer, const std::vector<DeliveredFrame>& frames, int n_threads)
      : renderer_(renderer), frames_(frames), slots_(static_cast<std::size_t>(n_threads) + 2) {
    const auto& camera = renderer.scene().camera;
    for (Slot& slot : slots_) {
      slot.pixels.resize(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
    }
    for (int i = 0; i < n_threads; ++i) workers_.emplace_back([this] { work(); });
  }

  ~FrameFarm() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    for (std::thread& worker : workers_) worker.join();
  }

  FrameFarm(const FrameFarm&) = delete;
  FrameFarm& operator=(const FrameFarm&) = delete;

  // The next frame in order; valid until give_back().
  const std::uint8_t* wait_for_next() {
    std::unique_lock lock(mutex_);
    Slot& slot = slots_[n_taken_ % slots_.size()];
    changed_.wait(lock, [&] { return slot.ready; });
    return slot.pixels.data();
  }

  void give_back() {
    {
      const std::lock_guard lock(mutex_);
      slots_[n_taken_ % slots_.size()].ready = false;
      ++n_taken_;
    }
    changed_.notify_all();
  }

 private:
  struct Slot {
    std::vector<std::uint8_t> pixels;
    bool ready = false;
  };

  void work() {
    Renderer::Scratch scratch = renderer_.make_scratch();
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return stopping_ || n_claimed_ < n_taken_ + slots_.size(); });
      if (stopping_ || n_claimed_ >= frames_.size()) return;
      const std::size_t i = n_claimed_++;
      Slot& slot = slots_[i % slots_.size()];
      lock.unlock();
      renderer_.render(frames_[i], slot.pixels.data(), scratch);
      lock.lock();
      slot.ready = true;
      changed_.notify_all();
    }
  }

  const Renderer& renderer_;
  const std::vector<DeliveredFrame>& frames_;
  std::vector<Slot> slots_;
  std::vector<std::thread> workers_;
  std::mutex mutex_;  // guards all members below and Slot::ready
  std::condition_variable changed_;
  std::size_t n_claimed_ = 0, n_taken_ = 0;
  bool stopping_ = false;
};

// The frames go to `writer`, in order. The stamps that they need are written first: a clip never exists without them.
template <typename Writer>
void write_frames(const Renderer& renderer, const std::string& path, Writer& writer, int n_threads, bool is_quiet) {
  const std::vector<DeliveredFrame> frames = delivered_frames(renderer.scene());
  FrameFarm farm(renderer, frames, n_threads);
  Progress progress("simulate", frames.size(), "frames", is_quiet);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    writer.write(farm.wait_for_next());
    farm.give_back();
    progress.update(i + 1);
  }
  if (needs_stamps(renderer.scene())) write_stamps(stamps_path(path), frames);
  writer.finish();
}

}  // namespace

bool needs_stamps(const core::simulation::Scene& scene) noexcept {
  return scene.timing.stamps_tell && (scene.timing.jitter_rms_s > 0.0 || scene.timing.drop_probability > 0.0);
}

std::string stamps_path(const std::string& clip_path) {
  return std::filesystem::path(clip_path).replace_extension(".timestamps.csv").string();
}

void write_clip(const Renderer& renderer, const std::string& path, std::optional<int> crf, int n_threads,
                bool is_quiet) {
  const auto& camera = renderer.scene().camera;
  std::filesystem::remove(stamps_path(path));
  if (crf) {
    drivers::ClipWriter writer(path, camera.width_px, camera.height_px, camera.rate_hz, *crf);
    write_frames(renderer, path, writer, n_threads, is_quiet);
  } else {
    RawClip writer(path, camera.width_px, camera.height_px, camera.rate_hz);
    write_frames(renderer, path, writer, n_threads, is_quiet);
  }
}

}  // namespace tools
