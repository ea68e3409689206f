#include "drivers/telemetry/disk_sync.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "drivers/storage/partial_file.h"

namespace drivers {

DiskSync::DiskSync(std::chrono::milliseconds period) : period_(period), thread_([this] { run(); }) {}

DiskSync::~DiskSync() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_one();
  thread_.join();
  if (descriptor_ >= 0) ::close(descriptor_);
}

void DiskSync::request(int descriptor) noexcept {
  {
    const std::lock_guard lock(mutex_);
    if (descriptor_ >= 0 || std::chrono::steady_clock::now() < next_) return;
    descriptor_ = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
    if (descriptor_ < 0) {
      error_.store(errno, std::memory_order_relaxed);
      return;
    }
  }
  changed_.notify_one();
}

void DiskSync::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_over_ || descriptor_ >= 0; });
    if (is_over_) return;
    const int descriptor = descriptor_;
    lock.unlock();
    if (!sync_to_disk(descriptor)) error_.store(errno, std::memory_order_relaxed);
    ::close(descriptor);
    lock.lock();
    descriptor_ = -1;
    next_ = std::chrono::steady_clock::now() + period_;
    n_done_.fetch_add(1, std::memory_order_release);
  }
}

}  // namespace drivers
