#include "drivers/camera/device/live_sequence.h"

#include <gtest/gtest.h>

#include "drivers/camera/device/stamp_clock.h"

namespace drivers {
namespace {

constexpr std::int64_t kPeriod_ns = 40'000'000;  // 25 Hz

TEST(LiveSequence, FollowsTheDeviceAcrossItsWrap) {
  LiveSequence sequence(25.0);
  std::int64_t t_ns = 0;
  EXPECT_EQ(sequence.next(0xFFFF'FFFE, t_ns).sequence, 0u);
  EXPECT_EQ(sequence.next(0xFFFF'FFFF, t_ns += kPeriod_ns).sequence, 1u);
  const LiveSequence::Step wrapped = sequence.next(0, t_ns += kPeriod_ns);
  EXPECT_EQ(wrapped.sequence, 2u);
  EXPECT_FALSE(wrapped.gap_before);
  const LiveSequence::Step after_loss = sequence.next(4, t_ns += 4 * kPeriod_ns);
  EXPECT_EQ(after_loss.sequence, 6u);
  EXPECT_TRUE(after_loss.gap_before);
}

TEST(LiveSequence, CountsByTimeWhereTheDeviceDoesNot) {
  LiveSequence sequence(25.0);
  EXPECT_EQ(sequence.next(0, 0).sequence, 0u);
  EXPECT_EQ(sequence.next(0, kPeriod_ns + 3'000'000).sequence, 1u);
  const LiveSequence::Step late = sequence.next(0, 4 * kPeriod_ns - 2'000'000);
  EXPECT_EQ(late.sequence, 4u);
  EXPECT_TRUE(late.gap_before);
  EXPECT_EQ(sequence.next(0, 4 * kPeriod_ns - 2'000'000).sequence, 5u) << "never twice the same";
}

TEST(LiveSequence, AnInterruptionIsAGapOfTheTimeItTook) {
  LiveSequence sequence(25.0);
  EXPECT_EQ(sequence.next(100, 0).sequence, 0u);
  EXPECT_EQ(sequence.next(101, kPeriod_ns).sequence, 1u);
  sequence.interrupted();
  const LiveSequence::Step back = sequence.next(0, 51 * kPeriod_ns);
  EXPECT_EQ(back.sequence, 51u);
  EXPECT_TRUE(back.gap_before);
  EXPECT_EQ(sequence.next(1, 52 * kPeriod_ns).sequence, 52u);
  const LiveSequence::Step restarted = sequence.next(0, 53 * kPeriod_ns);  // back without an interruption reported
  EXPECT_EQ(restarted.sequence, 53u);
}

TEST(StampClock, FindsTheClockAndConverts) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const StampClock::Now now{1000 * kSecond_ns, 5000 * kSecond_ns, 1'700'000'000 * kSecond_ns};
  const auto had = [&](std::int64_t stamp_ns, StampClock::Kind kind) {
    StampClock clock;
    const std::int64_t t_ns = clock.to_monotonic_ns(stamp_ns, now);
    EXPECT_EQ(clock.kind(), kind) << to_string(clock.kind());
    return t_ns;
  };
  constexpr std::int64_t kAge_ns = 20'000'000;
  EXPECT_EQ(had(now.monotonic_ns - kAge_ns, StampClock::Kind::kMonotonic), now.monotonic_ns - kAge_ns);
  EXPECT_EQ(had(now.boottime_ns - kAge_ns, StampClock::Kind::kBoottime), now.monotonic_ns - kAge_ns);
  EXPECT_EQ(had(now.realtime_ns - kAge_ns, StampClock::Kind::kRealtime), now.monotonic_ns - kAge_ns);
  EXPECT_EQ(had(12345, StampClock::Kind::kArrival), now.monotonic_ns);
  EXPECT_EQ(had(now.monotonic_ns + kSecond_ns, StampClock::Kind::kArrival), now.monotonic_ns) << "from the future";
}

}  // namespace
}  // namespace drivers
