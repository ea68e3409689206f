#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <vector>

#include "rt/event_log.h"
#include "rt/spsc_ring.h"
#include "rt/stage_stats.h"
#include "rt/triple_buffer.h"
#include "rt/wakeup.h"
#include "tests/support/alloc_guard.h"

namespace rt {
namespace {

using test_support::AllocGuard;

TEST(AllocGuard, CountsWhatTheThreadAllocatesAndFrees) {
  if (!test_support::kAllocationsCounted) GTEST_SKIP() << "AddressSanitizer has operators of its own";
  std::size_t n_new = 0;
  std::size_t n_delete = 0;
  {
    const AllocGuard guard;
    auto number = std::make_unique<std::vector<int>>(3);  // the object and its buffer
    number.reset();
    n_new = guard.n_new();
    n_delete = guard.n_delete();
  }
  EXPECT_EQ(n_new, 2U);
  EXPECT_EQ(n_delete, 2U);
}

TEST(RunPathAllocation, RingMovesItemsWithoutAllocating) {
  Wakeup reader_wakeup;
  Wakeup writer_wakeup;
  SpscRing<std::vector<double>> ring(4, std::vector<double>(100, 0.0));
  ring.set_reader_wakeup(&reader_wakeup);
  ring.set_writer_wakeup(&writer_wakeup);
  RingWriter<std::vector<double>> writer = ring.writer();
  RingReader<std::vector<double>> reader = ring.reader();
  const std::vector<double> source(100, 1.5);
  double sum = 0.0;
  std::size_t n_calls = 0;
  {
    const AllocGuard guard;
    for (int i = 0; i < 100; ++i) {
      while (std::vector<double>* slot = writer.try_claim()) {
        *slot = source;
        writer.publish();
      }
      while (const std::vector<double>* item = reader.front()) {
        sum += item->back();
        reader.pop();
      }
    }
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_EQ(sum, 600.0);
  EXPECT_EQ(n_calls, 0U);
}

TEST(RunPathAllocation, TripleBufferHandsOverWithoutAllocating) {
  TripleBuffer<std::vector<double>> buffer(std::vector<double>(100, 0.0));
  const std::vector<double> source(100, 2.0);
  double sum = 0.0;
  std::size_t n_calls = 0;
  {
    const AllocGuard guard;
    for (int i = 0; i < 100; ++i) {
      buffer.back() = source;
      buffer.publish();
      if (buffer.refresh()) sum += buffer.front().back();
    }
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_EQ(sum, 200.0);
  EXPECT_EQ(n_calls, 0U);
}

TEST(RunPathAllocation, WakeupWaitsWithoutAllocating) {
  Wakeup wakeup;
  std::size_t n_calls = 0;
  {
    const AllocGuard guard;
    for (int i = 0; i < 10; ++i) {
      const Wakeup::Ticket ticket = wakeup.ticket();
      wakeup.nudge();
      wakeup.wait(ticket, std::chrono::milliseconds(1000));
      wakeup.wait(wakeup.ticket(), std::chrono::milliseconds(1));
    }
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_EQ(n_calls, 0U);
}

TEST(RunPathAllocation, EventsAndLatenciesAreNotedWithoutAllocating) {
  EventLog log(8);
  StageStats stats;
  std::size_t n_calls = 0;
  std::uint64_t n_seen = 0;
  {
    const AllocGuard guard;
    for (int i = 0; i < 100; ++i) {
      log.write("step {} took {}", i, 3);  // runs full, too
      stats.step.add(i);
      if (i % 20 == 0) n_seen += log.drain([](const Event&) {}) + stats.step.percentiles().n;
    }
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_GT(n_seen, 0U);
  EXPECT_EQ(n_calls, 0U);
}

}  // namespace
}  // namespace rt
