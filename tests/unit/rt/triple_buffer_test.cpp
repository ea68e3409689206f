#include "rt/triple_buffer.h"

#include <gtest/gtest.h>

#include <vector>

namespace rt {
namespace {

void publish(TripleBuffer<int>& buffer, int value) {
  buffer.back() = value;
  buffer.publish();
}

TEST(TripleBuffer, HasNothingFreshBeforeTheFirstPublish) {
  TripleBuffer<int> buffer(7);
  EXPECT_FALSE(buffer.refresh());
  EXPECT_EQ(buffer.front(), 7);
  EXPECT_TRUE(buffer.taken());
}

TEST(TripleBuffer, GivesTheNewestValueOnce) {
  TripleBuffer<int> buffer(0);
  publish(buffer, 1);
  publish(buffer, 2);
  publish(buffer, 3);
  EXPECT_TRUE(buffer.refresh());
  EXPECT_EQ(buffer.front(), 3);
  EXPECT_FALSE(buffer.refresh());
  EXPECT_EQ(buffer.front(), 3);
}

TEST(TripleBuffer, NeverLendsTheReadersBufferToTheWriter) {
  TripleBuffer<int> buffer(0);
  publish(buffer, 1);
  ASSERT_TRUE(buffer.refresh());
  const int* read = &buffer.front();
  for (int i = 2; i < 20; ++i) {
    ASSERT_NE(&buffer.back(), read);
    publish(buffer, i);
    ASSERT_EQ(*read, 1);
  }
  EXPECT_TRUE(buffer.refresh());
  EXPECT_EQ(buffer.front(), 19);
}

TEST(TripleBuffer, TellsTheWriterWhenTheValueWasTaken) {
  TripleBuffer<int> buffer(0);
  publish(buffer, 1);
  EXPECT_FALSE(buffer.taken());
  ASSERT_TRUE(buffer.refresh());
  EXPECT_TRUE(buffer.taken());
}

TEST(TripleBuffer, TellsTheWriterWhenAValueWasLost) {
  TripleBuffer<int> buffer(0);
  EXPECT_TRUE(buffer.publish());
  EXPECT_FALSE(buffer.publish()) << "the first was never taken";
  ASSERT_TRUE(buffer.refresh());
  EXPECT_TRUE(buffer.publish());
}

TEST(TripleBuffer, FinishesOnlyWhenClosedAndTaken) {
  TripleBuffer<int> buffer(0);
  EXPECT_FALSE(buffer.finished());
  publish(buffer, 1);
  buffer.close();
  EXPECT_FALSE(buffer.finished()) << "the last value is still to be taken";
  ASSERT_TRUE(buffer.refresh());
  EXPECT_EQ(buffer.front(), 1);
  EXPECT_TRUE(buffer.finished());
}

TEST(TripleBuffer, NudgesTheOtherSide) {
  Wakeup reader;
  Wakeup writer;
  TripleBuffer<int> buffer(0);
  buffer.set_reader_wakeup(&reader);
  buffer.set_writer_wakeup(&writer);
  const Wakeup::Ticket reader_before = reader.ticket();
  const Wakeup::Ticket writer_before = writer.ticket();
  publish(buffer, 1);
  const Wakeup::Ticket reader_published = reader.ticket();
  EXPECT_NE(reader_published, reader_before);
  EXPECT_EQ(writer.ticket(), writer_before);
  ASSERT_TRUE(buffer.refresh());
  EXPECT_NE(writer.ticket(), writer_before);
  buffer.close();
  EXPECT_NE(reader.ticket(), reader_published);
}

TEST(TripleBuffer, AllThreeBuffersAreCopiesOfThePrototype) {
  TripleBuffer<std::vector<int>> buffer(std::vector<int>(4, 1));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(buffer.back(), std::vector<int>(4, 1));
    buffer.publish();
    ASSERT_TRUE(buffer.refresh());
  }
}

}  // namespace
}  // namespace rt
