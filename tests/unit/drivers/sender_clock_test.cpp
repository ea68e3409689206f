#include "drivers/camera/network/sender_clock.h"

#include <gtest/gtest.h>

namespace drivers {
namespace {

constexpr std::int64_t kFrame_ns = 40'000'000, kSecond_ns = 1'000'000'000;

// Pictures sent every 40 ms from 0 on, that arrive `delay_ns` late.
class Sender {
 public:
  std::optional<std::int64_t> next(SenderClock& clock, std::int64_t delay_ns) {
    const std::int64_t sent_ns = kFrame_ns * n_++;
    return clock.to_monotonic_ns(offset_ns_ + sent_ns, kStart_ns + sent_ns + delay_ns);
  }
  void jump(std::int64_t by_ns) { offset_ns_ += by_ns; }
  [[nodiscard]] std::int64_t last_start_ns() const { return kStart_ns + kFrame_ns * (n_ - 1); }

 private:
  static constexpr std::int64_t kStart_ns = 77 * kSecond_ns;
  std::int64_t n_ = 0, offset_ns_ = 12345;
};

TEST(SenderClock, TheLeastDelayOfTheFirstSecondIsTheOffset) {
  SenderClock clock;
  Sender sender;
  for (int k = 0; k < 25; ++k) EXPECT_FALSE(sender.next(clock, k == 7 ? 20'000'000 : 90'000'000 - k));
  (void)sender.next(clock, 95'000'000);
  for (int k = 0; k < 50; ++k) {
    const auto t_ns = sender.next(clock, k % 2 == 0 ? 200'000'000 : 25'000'000);
    ASSERT_TRUE(t_ns);
    EXPECT_EQ(*t_ns, sender.last_start_ns() + 20'000'000);
  }
}

TEST(SenderClock, AJumpOfTheSendersClockBeginsAnew) {
  for (const std::int64_t by_ns : {100 * kSecond_ns, -100 * kSecond_ns, -kFrame_ns}) {
    SenderClock clock;
    Sender sender;
    for (int k = 0; k < 30; ++k) (void)sender.next(clock, 20'000'000);
    sender.jump(by_ns);
    EXPECT_FALSE(sender.next(clock, 20'000'000)) << by_ns;
    for (int k = 0; k < 30; ++k) (void)sender.next(clock, 30'000'000);
    const auto t_ns = sender.next(clock, 50'000'000);
    EXPECT_EQ(t_ns, sender.last_start_ns() + 20'000'000) << by_ns;
  }
}

TEST(SenderClock, WithoutASendersTimesArrivalsAreUsed) {
  SenderClock clock;
  EXPECT_EQ(clock.to_monotonic_ns({}, 55), 55);
}

}  // namespace
}  // namespace drivers
