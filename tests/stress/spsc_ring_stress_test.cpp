#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "rt/clock.h"
#include "rt/spsc_ring.h"
#include "tests/stress/payload.h"

namespace rt {
namespace {

using namespace std::chrono_literals;
constexpr std::int64_t kDuration_ns = 300'000'000;

struct Ends {
  SpscRing<stress::Payload> ring;
  Wakeup reader_wakeup, writer_wakeup;

  explicit Ends(std::size_t n_slots) : ring(n_slots, stress::Payload{}) {
    ring.set_reader_wakeup(&reader_wakeup);
    ring.set_writer_wakeup(&writer_wakeup);
  }
};

// Lossless: the writer waits while the ring is full.
std::uint64_t produce(Ends& ends) {
  RingWriter<stress::Payload> writer = ends.ring.writer();
  const std::int64_t end_ns = monotonic_ns() + kDuration_ns;
  std::uint64_t n = 0;
  while (monotonic_ns() < end_ns) {
    const Wakeup::Ticket ticket = ends.writer_wakeup.ticket();
    if (stress::Payload* slot = writer.try_claim()) {
      slot->fill(n++);
      writer.publish();
    } else {
      ends.writer_wakeup.wait(ticket, 1h);
    }
  }
  writer.close();
  return n;
}

void run(std::size_t n_slots) {
  Ends ends(n_slots);
  std::uint64_t n_written = 0;
  std::thread producer([&] { n_written = produce(ends); });
  RingReader<stress::Payload> reader = ends.ring.reader();
  std::uint64_t n_read = 0;
  std::uint64_t n_torn = 0;
  for (;;) {
    const Wakeup::Ticket ticket = ends.reader_wakeup.ticket();
    if (const stress::Payload* item = reader.front()) {
      n_torn += item->whole() && item->number() == n_read ? 0U : 1U;
      ++n_read;
      reader.pop();
    } else if (reader.finished()) {
      break;
    } else {
      ends.reader_wakeup.wait(ticket, 1h);
    }
  }
  producer.join();
  EXPECT_EQ(n_torn, 0U);
  EXPECT_EQ(n_read, n_written);
  EXPECT_GT(n_read, 0U);
}

TEST(SpscRingStress, OneSlotLosesAndTearsNothing) { run(1); }
TEST(SpscRingStress, ThreeSlotsLoseAndTearNothing) { run(3); }
TEST(SpscRingStress, SixtyFourSlotsLoseAndTearNothing) { run(64); }

}  // namespace
}  // namespace rt
