#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "rt/spsc_ring.h"

namespace {

// For any order of operations the ring behaves like a std::deque that refuses to grow beyond its slots.
void play(std::uint32_t seed) {
  std::mt19937 random(seed);
  const std::size_t n_slots = 1 + random() % 9;
  rt::SpscRing<std::uint32_t> ring(n_slots, 0U);
  rt::RingWriter<std::uint32_t> writer = ring.writer();
  rt::RingReader<std::uint32_t> reader = ring.reader();
  std::deque<std::uint32_t> model;
  bool closed = false;
  const std::uint64_t write_share = 1 + random() % 9;  // of ten: some runs fill up, others run dry
  for (int step = 0; step < 400; ++step) {
    if (random() % 10 < write_share && !closed) {
      std::uint32_t* slot = writer.try_claim();
      ASSERT_EQ(slot == nullptr, model.size() == n_slots);
      if (slot == nullptr || random() % 8 == 0) continue;  // claimed but not published: no effect
      *slot = static_cast<std::uint32_t>(random());
      model.push_back(*slot);
      writer.publish();
    } else {
      const std::uint32_t* item = reader.front();
      ASSERT_EQ(item == nullptr, model.empty());
      if (item == nullptr) continue;
      ASSERT_EQ(*item, model.front());
      if (random() % 4 == 0) continue;  // read but not popped
      reader.pop();
      model.pop_front();
    }
    if (step == 350) {
      writer.close();
      closed = true;
    }
    ASSERT_EQ(ring.depth(), model.size());
    ASSERT_EQ(reader.finished(), closed && model.empty());
  }
}

TEST(SpscRingProperty, BehavesAsADequeUnderRandomOperations) {
  for (std::uint32_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(seed);
    play(seed);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
