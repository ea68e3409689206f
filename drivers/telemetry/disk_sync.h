#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

namespace drivers {

// Brings what a file holds to the disk again and again while it is written, so that a loss of power takes its last
// seconds only. A thread of its own waits for the disk. On ext4, XFS, Btrfs and F2FS this includes the name of a new
// file.
class DiskSync {
 public:
  explicit DiskSync(std::chrono::milliseconds period = std::chrono::seconds(2));
  ~DiskSync();  // waits for the disk where it is at work
  DiskSync(const DiskSync&) = delete;
  DiskSync& operator=(const DiskSync&) = delete;

  // What was written to this open file. Returns at once; nothing happens while the disk is at work, or within the
  // period after it. The file may be closed afterwards. Called by one thread.
  void request(int descriptor) noexcept;

  // Any thread. errno of the last failure; 0: none. The kernel states a failure once: here, and no longer when the file
  // is closed.
  [[nodiscard]] int error() const noexcept { return error_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t n_done() const noexcept { return n_done_.load(std::memory_order_acquire); }

 private:
  void run();

  std::chrono::milliseconds period_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int descriptor_ = -1;  // a duplicate of the file's, from its request to the end of the work on it; -1: idle
  bool is_over_ = false;
  std::chrono::steady_clock::time_point next_{};
  std::atomic<int> error_{0};
  std::atomic<std::uint64_t> n_done_{0};
  std::thread thread_;
};

}  // namespace drivers
