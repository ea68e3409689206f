#include "tools/hovermodal/simulate_clip.h"

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "drivers/storage/clip_writer.h"
#include "tools/hovermodal/simulate_progress.h"

namespace tools {
namespace {

using core::simulation::Renderer;

// Frames drawn by several threads, handed out in order. Frame k lives in slot k % n_slots; a worker may draw it once
// frame k - n_slots has been given back.
class FrameFarm {
 public:
  FrameFarm(const Renderer& renderer, int n_threads)
      : renderer_(renderer), slots_(static_cast<std::size_t>(n_threads) + 2) {
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
      if (stopping_ || n_claimed_ >= renderer_.scene().n_frames()) return;
      const std::uint64_t frame = n_claimed_++;
      Slot& slot = slots_[frame % slots_.size()];
      lock.unlock();
      renderer_.render(frame, slot.pixels.data(), scratch);
      lock.lock();
      slot.ready = true;
      changed_.notify_all();
    }
  }

  const Renderer& renderer_;
  std::vector<Slot> slots_;
  std::vector<std::thread> workers_;
  std::mutex mutex_;  // guards all below and Slot::ready
  std::condition_variable changed_;
  std::uint64_t n_claimed_ = 0, n_taken_ = 0;
  bool stopping_ = false;
};

}  // namespace

void write_clip(const Renderer& renderer, const std::string& path, int crf, int n_threads) {
  const auto& camera = renderer.scene().camera;
  drivers::ClipWriter writer(path, camera.width_px, camera.height_px, camera.rate_hz, crf);
  FrameFarm farm(renderer, n_threads);
  const std::uint64_t n_frames = renderer.scene().n_frames();
  Progress progress("simulate", n_frames);
  for (std::uint64_t frame = 0; frame < n_frames; ++frame) {
    writer.write(farm.wait_for_next());
    farm.give_back();
    progress.update(frame + 1);
  }
  writer.finish();
}

}  // namespace tools
