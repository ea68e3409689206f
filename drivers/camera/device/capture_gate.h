#pragma once

#include <atomic>

namespace drivers {

// Lets `stop`, called by any thread, wait until `capture` has left, without a lock in `capture`. Each side stores its
// flag before it loads the other's (sequentially consistent): at least one of them sees the other's flag.
class CaptureGate {
 public:
  class Pass {
   public:
    explicit Pass(CaptureGate& gate) noexcept : gate_(gate) { gate_.inside_.store(true); }
    ~Pass() {
      gate_.inside_.store(false);
      if (gate_.is_closed_.load()) gate_.inside_.notify_all();
    }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

   private:
    CaptureGate& gate_;
  };

  [[nodiscard]] bool is_closed() const noexcept { return is_closed_.load(); }
  void open() noexcept { is_closed_.store(false); }
  // Between `shut` and `wait_until_left` the caller must wake `capture` from its wait.
  void shut() noexcept { is_closed_.store(true); }
  void wait_until_left() noexcept { inside_.wait(true); }

 private:
  std::atomic<bool> is_closed_{true};
  std::atomic<bool> inside_{false};
};

}  // namespace drivers
