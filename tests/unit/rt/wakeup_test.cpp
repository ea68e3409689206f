#include "rt/wakeup.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "rt/clock.h"

namespace rt {
namespace {

using namespace std::chrono_literals;

// A lost nudge shows as a hang: nothing here ever comes near an hour.
constexpr std::chrono::milliseconds kForever = 1h;

TEST(Wakeup, ANudgeBetweenTicketAndWaitIsNotLost) {
  Wakeup wakeup;
  const Wakeup::Ticket ticket = wakeup.ticket();
  wakeup.nudge();
  wakeup.wait(ticket, kForever);
  SUCCEED();
}

TEST(Wakeup, ManyNudgesEndOneWait) {
  Wakeup wakeup;
  const Wakeup::Ticket ticket = wakeup.ticket();
  for (int i = 0; i < 100; ++i) wakeup.nudge();
  wakeup.wait(ticket, kForever);
  EXPECT_EQ(wakeup.ticket(), ticket + 100);
}

TEST(Wakeup, AnOldNudgeDoesNotEndANewWait) {
  Wakeup wakeup;
  wakeup.nudge();
  const std::int64_t begin_ns = monotonic_ns();
  wakeup.wait(wakeup.ticket(), 20ms);
  // A signal may end the wait early, so it is only known not to return at once: a thousandth of the time-out.
  EXPECT_GT(monotonic_ns() - begin_ns, 20'000);
}

TEST(Wakeup, ReturnsAfterTheTimeoutWithoutANudge) {
  Wakeup wakeup;
  for (const auto timeout : {-5ms, 0ms, 1ms, 5ms}) {
    const Wakeup::Ticket ticket = wakeup.ticket();
    wakeup.wait(ticket, timeout);
    EXPECT_EQ(wakeup.ticket(), ticket);
  }
}

TEST(Wakeup, ANudgeFromAnotherThreadEndsTheWait) {
  Wakeup wakeup;
  std::atomic<bool> done{false};
  std::thread waiter([&] {
    for (;;) {
      const Wakeup::Ticket ticket = wakeup.ticket();
      if (done.load()) break;
      wakeup.wait(ticket, kForever);
    }
  });
  std::this_thread::sleep_for(5ms);  // most likely asleep by now; right either way
  done.store(true);
  wakeup.nudge();
  waiter.join();
}

// Two threads hand a token back and forth: every hand-over is one chance to lose a nudge.
TEST(Wakeup, NoNudgeIsLostInAPingPong) {
  constexpr int kRounds = 5000;
  Wakeup even;
  Wakeup odd;
  std::atomic<int> turn{0};
  const auto play = [&turn](Wakeup& mine, Wakeup& theirs, int parity) {
    for (;;) {
      const Wakeup::Ticket ticket = mine.ticket();
      const int now = turn.load();
      if (now >= kRounds) break;
      if (now % 2 != parity) {
        mine.wait(ticket, kForever);
        continue;
      }
      turn.store(now + 1);
      theirs.nudge();
    }
    theirs.nudge();
  };
  std::thread other([&] { play(odd, even, 1); });
  play(even, odd, 0);
  other.join();
  EXPECT_EQ(turn.load(), kRounds);
}

}  // namespace
}  // namespace rt
