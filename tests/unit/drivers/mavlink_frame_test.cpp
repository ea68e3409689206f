#include "drivers/mavlink/mavlink_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <vector>

#include "drivers/mavlink/mavlink_layouts.h"

namespace drivers {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const MavlinkFrame& frame) {
  std::array<std::uint8_t, kMavlinkMostBytes> out{};
  const std::size_t n = write_mavlink(frame, out);
  return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(n)};
}

std::vector<MavlinkFrame> parsed(MavlinkParser& parser, const Bytes& bytes) {
  std::vector<MavlinkFrame> out;
  parser.push(bytes, [&](const MavlinkFrame& frame) { out.push_back(frame); });
  return out;
}

MavlinkFrame drawn_frame(std::mt19937& engine) {
  MavlinkFrame frame;
  const MavlinkLayout& layout = kMavlinkLayouts[engine() % kMavlinkLayouts.size()];
  frame.id = layout.id;
  frame.sequence = static_cast<std::uint8_t>(engine());
  frame.system = 7, frame.component = 1;
  for (std::size_t i = 0; i < layout.size; ++i) frame.payload[i] = static_cast<std::uint8_t>(engine());
  return frame;
}

// Its checksum was computed bit by bit, as CRC-16/MCRF4XX, with the extra byte 50.
TEST(MavlinkFrame, AHeartbeatHasTheBytesOfItsDefinition) {
  MavlinkFrame frame;
  frame.id = 0, frame.sequence = 3, frame.system = 1, frame.component = 191;
  frame.payload[4] = 18, frame.payload[5] = 8, frame.payload[7] = 4, frame.payload[8] = 3;
  const Bytes bytes = bytes_of(frame);
  const Bytes head{0xFD, 9, 0, 0, 3, 1, 191, 0, 0, 0, 0, 0, 0, 0, 18, 8, 0, 4, 3};
  ASSERT_EQ(bytes.size(), head.size() + 2);
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
  EXPECT_EQ(bytes[19], 0x8f);
  EXPECT_EQ(bytes[20], 0x5c);
}

TEST(MavlinkFrame, ZerosAtTheEndAreLeftOutAndReadBack) {
  MavlinkFrame frame;
  frame.id = MavlinkFields::Timesync::kId;
  frame.payload[8] = 5;
  EXPECT_EQ(bytes_of(frame).size(), 10U + 9U + 2U);
  MavlinkParser parser;
  const auto back = parsed(parser, bytes_of(frame));
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].payload, frame.payload);
  frame.payload = {};
  EXPECT_EQ(bytes_of(frame).size(), 10U + 1U + 2U) << "the first byte is always sent";
}

TEST(MavlinkFrame, AnUnknownIdIsNotWritten) {
  MavlinkFrame frame;
  frame.id = 0xABCDEF;
  EXPECT_TRUE(bytes_of(frame).empty());
}

TEST(MavlinkParser, NoiseBetweenFramesCostsNone) {
  std::mt19937 engine(3);
  Bytes stream;
  std::vector<MavlinkFrame> sent;
  for (int i = 0; i < 2000; ++i) {
    for (std::size_t k = engine() % 40; k > 0; --k)
      stream.push_back(engine() % 8 == 0 ? 0xFD : static_cast<std::uint8_t>(engine()));
    sent.push_back(drawn_frame(engine));
    const Bytes bytes = bytes_of(sent.back());
    stream.insert(stream.end(), bytes.begin(), bytes.end());
  }
  stream.insert(stream.end(), kMavlinkMostBytes, 0);  // what may belong to a start within the noise has come
  MavlinkParser parser;
  const auto found = parsed(parser, stream);
  ASSERT_EQ(found.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(found[i].id, sent[i].id);
    EXPECT_EQ(found[i].payload, sent[i].payload);
  }
  EXPECT_EQ(parser.counts().frames, sent.size());
  EXPECT_GT(parser.counts().skipped_bytes, 0U);
}

TEST(MavlinkParser, OneWrongBitIsNoFrame) {
  std::mt19937 engine(5);
  const Bytes good = bytes_of(drawn_frame(engine));
  for (std::size_t bit = 8; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1U << (bit % 8)));
    bad.insert(bad.end(), kMavlinkMostBytes, 0);
    MavlinkParser parser;
    EXPECT_TRUE(parsed(parser, bad).empty()) << "bit " << bit;
  }
}

TEST(MavlinkParser, ASignedFrameIsReadAndADatagramEnds) {
  std::mt19937 engine(7);
  MavlinkParser parser;
  const Bytes bytes = bytes_of(drawn_frame(engine));
  EXPECT_TRUE(parsed(parser, {bytes.begin(), bytes.end() - 1}).empty());
  parser.end_datagram();
  EXPECT_EQ(parsed(parser, bytes).size(), 1U) << "the part before is forgotten";
  MavlinkFrame frame = drawn_frame(engine);
  Bytes with_signature = bytes_of(frame);
  with_signature[2] = 1;
  const std::size_t n = with_signature.size() - 2;
  const auto* layout = std::find_if(kMavlinkLayouts.begin(), kMavlinkLayouts.end(),
                                    [&](const MavlinkLayout& l) { return l.id == frame.id; });
  const std::uint16_t crc = mavlink_checksum(std::span(with_signature).subspan(1, n - 1), layout->crc_extra);
  with_signature[n] = static_cast<std::uint8_t>(crc & 0xFFU),
  with_signature[n + 1] = static_cast<std::uint8_t>(crc >> 8U);
  with_signature.insert(with_signature.end(), 13, 0x55);
  EXPECT_EQ(parsed(parser, with_signature).size(), 1U);
  EXPECT_EQ(parsed(parser, bytes).size(), 1U) << "the signature is skipped";
}

}  // namespace
}  // namespace drivers
