#include "rt/spsc_ring.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

namespace rt {
namespace {

using namespace std::chrono_literals;

bool push(RingWriter<int>& writer, int value) {
  int* slot = writer.try_claim();
  if (slot == nullptr) return false;
  *slot = value;
  writer.publish();
  return true;
}

TEST(SpscRing, HoldsExactlyItsSlots) {
  for (const std::size_t n_slots : {std::size_t{1}, std::size_t{3}, std::size_t{8}}) {
    SpscRing<int> ring(n_slots, 0);
    RingWriter<int> writer = ring.writer();
    for (std::size_t i = 0; i < n_slots; ++i) {
      EXPECT_EQ(ring.depth(), i);
      EXPECT_TRUE(push(writer, static_cast<int>(i)));
    }
    EXPECT_FALSE(push(writer, 99));
    EXPECT_EQ(ring.depth(), n_slots);
    EXPECT_EQ(ring.n_slots(), n_slots);
  }
}

TEST(SpscRing, EverySlotStartsAsACopyOfThePrototype) {
  SpscRing<std::vector<int>> ring(3, std::vector<int>(5, 7));
  RingWriter<std::vector<int>> writer = ring.writer();
  for (int i = 0; i < 3; ++i) {
    const std::vector<int>* slot = writer.try_claim();
    ASSERT_NE(slot, nullptr);
    EXPECT_EQ(*slot, std::vector<int>(5, 7));
    writer.publish();
  }
}

TEST(SpscRing, KeepsTheOrderOverManyRounds) {
  SpscRing<int> ring(3, 0);
  RingWriter<int> writer = ring.writer();
  RingReader<int> reader = ring.reader();
  int next_in = 0;
  int next_out = 0;
  while (next_out < 1000) {
    while (push(writer, next_in)) ++next_in;
    for (int i = 0; i < 1 + next_out % 3; ++i) {
      const int* item = reader.front();
      ASSERT_NE(item, nullptr);
      ASSERT_EQ(*item, next_out++);
      reader.pop();
    }
  }
}

TEST(SpscRing, LendsTheSlotInPlaceAtBothEnds) {
  SpscRing<int> ring(2, 0);
  RingWriter<int> writer = ring.writer();
  RingReader<int> reader = ring.reader();
  int* claimed = writer.try_claim();
  EXPECT_EQ(writer.try_claim(), claimed) << "claiming twice without publish gives the same slot";
  EXPECT_EQ(reader.front(), nullptr) << "a claimed slot is not yet handed over";
  *claimed = 5;
  writer.publish();
  const int* read = reader.front();
  EXPECT_EQ(read, claimed);
  EXPECT_EQ(reader.front(), read) << "front() alone gives nothing back";
  EXPECT_NE(writer.try_claim(), claimed);
}

TEST(SpscRing, ALentSlotIsNotWrittenUntilItIsGivenBack) {
  SpscRing<int> ring(1, 0);
  RingWriter<int> writer = ring.writer();
  RingReader<int> reader = ring.reader();
  ASSERT_TRUE(push(writer, 1));
  ASSERT_NE(reader.front(), nullptr);
  EXPECT_EQ(writer.try_claim(), nullptr);
  reader.pop();
  EXPECT_NE(writer.try_claim(), nullptr);
  EXPECT_EQ(reader.front(), nullptr);
}

TEST(SpscRing, FinishesOnlyWhenClosedAndEmpty) {
  SpscRing<int> ring(2, 0);
  RingWriter<int> writer = ring.writer();
  RingReader<int> reader = ring.reader();
  EXPECT_FALSE(reader.finished()) << "empty, but open";
  ASSERT_TRUE(push(writer, 1));
  writer.close();
  EXPECT_FALSE(reader.finished()) << "closed, but an item is left";
  ASSERT_NE(reader.front(), nullptr);
  reader.pop();
  EXPECT_TRUE(reader.finished());
}

TEST(SpscRing, NudgesTheReaderOnPublishAndClose) {
  Wakeup wakeup;
  SpscRing<int> ring(2, 0);
  ring.set_reader_wakeup(&wakeup);
  RingWriter<int> writer = ring.writer();
  const Wakeup::Ticket before = wakeup.ticket();
  ASSERT_NE(writer.try_claim(), nullptr);
  EXPECT_EQ(wakeup.ticket(), before);
  writer.publish();
  const Wakeup::Ticket published = wakeup.ticket();
  EXPECT_NE(published, before);
  writer.close();
  EXPECT_NE(wakeup.ticket(), published);
}

TEST(SpscRing, NudgesTheWriterOnPop) {
  Wakeup wakeup;
  SpscRing<int> ring(1, 0);
  ring.set_writer_wakeup(&wakeup);
  RingWriter<int> writer = ring.writer();
  RingReader<int> reader = ring.reader();
  ASSERT_TRUE(push(writer, 1));
  ASSERT_NE(reader.front(), nullptr);
  const Wakeup::Ticket before = wakeup.ticket();
  reader.pop();
  EXPECT_NE(wakeup.ticket(), before);
}

// With a time-out of an hour a lost wake-up would hang the test.
TEST(SpscRing, AWaitingReaderAndAWaitingWriterWakeEachOther) {
  Wakeup reader_wakeup;
  Wakeup writer_wakeup;
  SpscRing<int> ring(1, 0);
  ring.set_reader_wakeup(&reader_wakeup);
  ring.set_writer_wakeup(&writer_wakeup);
  std::thread producer([&] {
    RingWriter<int> writer = ring.writer();
    for (int i = 0; i < 2000;) {
      const Wakeup::Ticket ticket = writer_wakeup.ticket();
      if (push(writer, i)) {
        ++i;
      } else {
        writer_wakeup.wait(ticket, 1h);
      }
    }
    writer.close();
  });
  RingReader<int> reader = ring.reader();
  int n_read = 0;
  for (;;) {
    const Wakeup::Ticket ticket = reader_wakeup.ticket();
    if (reader.front() != nullptr) {
      EXPECT_EQ(*reader.front(), n_read++);
      reader.pop();
    } else if (reader.finished()) {
      break;
    } else {
      reader_wakeup.wait(ticket, 1h);
    }
  }
  producer.join();
  EXPECT_EQ(n_read, 2000);
}

}  // namespace
}  // namespace rt
