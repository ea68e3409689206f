#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "rt/clock.h"
#include "rt/triple_buffer.h"
#include "tests/stress/payload.h"

namespace rt {
namespace {

using namespace std::chrono_literals;
constexpr std::int64_t kDuration_ns = 300'000'000;

struct Seen {
  std::uint64_t n = 0, n_torn = 0, n_backward = 0, last = 0;

  void take(const stress::Payload& payload) {
    n_torn += payload.whole() ? 0U : 1U;
    n_backward += n > 0 && payload.number() <= last ? 1U : 0U;
    last = payload.number();
    ++n;
  }
};

TEST(TripleBufferStress, TheReaderSeesWholeValuesInRisingOrderAndTheLastOne) {
  TripleBuffer<stress::Payload> buffer{stress::Payload{}};
  std::uint64_t n_published = 0;
  std::thread writer([&] {
    const std::int64_t end_ns = monotonic_ns() + kDuration_ns;
    while (monotonic_ns() < end_ns) {
      buffer.back().fill(++n_published);
      buffer.publish();
      if (n_published % 64 == 0) std::this_thread::yield();  // lets the reader run more often on a busy machine
    }
    buffer.close();
  });
  Seen seen;
  while (!buffer.finished()) {
    if (buffer.refresh()) seen.take(buffer.front());
  }
  writer.join();
  EXPECT_EQ(seen.n_torn, 0U);
  EXPECT_EQ(seen.n_backward, 0U);
  EXPECT_EQ(seen.last, n_published);
}

TEST(TripleBufferStress, AWriterThatWaitsForTakenLosesNothing) {
  Wakeup reader_wakeup;
  Wakeup writer_wakeup;
  TripleBuffer<stress::Payload> buffer{stress::Payload{}};
  buffer.set_reader_wakeup(&reader_wakeup);
  buffer.set_writer_wakeup(&writer_wakeup);
  std::uint64_t n_published = 0;
  std::thread writer([&] {
    const std::int64_t end_ns = monotonic_ns() + kDuration_ns;
    while (monotonic_ns() < end_ns) {
      const Wakeup::Ticket ticket = writer_wakeup.ticket();
      if (!buffer.taken()) {
        writer_wakeup.wait(ticket, 1h);
        continue;
      }
      buffer.back().fill(++n_published);
      buffer.publish();
    }
    buffer.close();
  });
  Seen seen;
  for (;;) {
    const Wakeup::Ticket ticket = reader_wakeup.ticket();
    if (buffer.refresh()) {
      seen.take(buffer.front());
    } else if (buffer.finished()) {
      break;
    } else {
      reader_wakeup.wait(ticket, 1h);
    }
  }
  writer.join();
  EXPECT_EQ(seen.n_torn, 0U);
  EXPECT_EQ(seen.n_backward, 0U);
  EXPECT_EQ(seen.n, n_published);
}

}  // namespace
}  // namespace rt
