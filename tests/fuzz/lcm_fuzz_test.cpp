#ifdef HOVERMODAL_WITH_LCM
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <memory>
#include <random>

#include "drivers/telemetry/decode.h"
#include "drivers/telemetry/encode.h"
#include "drivers/telemetry/stream_monitor.h"
#include "tests/support/telemetry_samples.h"

namespace {

using drivers::to_message;
using drivers::to_messages;
using Bytes = std::vector<std::uint8_t>;
using drivers::StreamMonitor;

template <class Message>
Bytes encoded(const Message& message) {
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

struct Seed {
  StreamMonitor::Topic topic;
  Bytes bytes;
  std::function<bool(const Bytes&)> decode;  // true when the bytes are such a message
};

template <class Message>
Seed seed(StreamMonitor::Topic topic, const Message& message) {
  return {topic, encoded(message),
          [](const Bytes& bytes) { return drivers::decode_message<Message>(bytes.data(), bytes.size()).has_value(); }};
}

std::vector<Seed> seeds() {
  const drivers::StreamIdentity identity{"fuzz", 1};
  const auto channels = tests::sample_channels(4);
  std::vector<Seed> out;
  out.push_back(seed(StreamMonitor::kModal, to_messages(tests::sample_estimate(4, 3), channels, identity).at(0)));
  out.push_back(seed(StreamMonitor::kDisplacement, to_message(tests::sample_displacement(4, 1), identity)));
  out.push_back(seed(StreamMonitor::kSpectrum, to_messages(tests::sample_sums(2, 16), channels, identity).at(0)));
  out.push_back(seed(StreamMonitor::kTracks, to_message(tests::sample_tracks(6, 1), identity)));
  out.push_back(seed(StreamMonitor::kPreview, to_message(tests::sample_preview(1), {core::Region{}}, identity)));
  out.push_back(seed(StreamMonitor::kHealth, to_message(tests::sample_health("running", 1), channels, identity)));
  return out;
}

// The bytes in a block of exactly their size, so that a sanitizer detects the first read beyond them.
class Exact {
 public:
  explicit Exact(const Bytes& bytes) : size_(bytes.size()), data_(new std::uint8_t[size_]) {
    if (size_ > 0) std::memcpy(data_.get(), bytes.data(), size_);
  }
  [[nodiscard]] const std::uint8_t* data() const { return data_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  std::unique_ptr<std::uint8_t[]> data_;
};

void feed(StreamMonitor& monitor, const Seed& s, const Bytes& bytes) {
  const Exact exact(bytes);
  monitor.receive(monitor.lcm_channel(s.topic), exact.data(), exact.size(), 1);
  static_cast<void>(s.decode(bytes));
  static_cast<void>(monitor.modes());
  for (std::size_t i = 0; i < monitor.n_channels(); ++i) static_cast<void>(monitor.channel_name(i));
}

std::uint64_t undecodable(const StreamMonitor& monitor) {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < StreamMonitor::kTopics; ++i) {
    n += monitor.count(static_cast<StreamMonitor::Topic>(i)).undecodable;
  }
  return n;
}

TEST(LcmFuzz, UnharmedSeedsDecode) {
  for (const auto& s : seeds()) EXPECT_TRUE(s.decode(s.bytes)) << s.topic;
}

TEST(LcmFuzz, EveryTruncationAndAnyTrailingByteIsUndecodable) {
  for (const auto& s : seeds()) {
    StreamMonitor monitor("FUZZ");
    for (std::size_t n = 0; n < s.bytes.size(); ++n) {
      const Bytes cut(s.bytes.begin(), s.bytes.begin() + static_cast<std::ptrdiff_t>(n));
      EXPECT_FALSE(s.decode(cut)) << s.topic << " cut to " << n;
      feed(monitor, s, cut);
    }
    Bytes longer = s.bytes;
    longer.push_back(0);
    feed(monitor, s, longer);
    EXPECT_EQ(undecodable(monitor), s.bytes.size() + 1);
  }
}

// Every length field, at every position, with each of the values that break a naive decoder.
TEST(LcmFuzz, HostileLengthsAtEveryPositionNeitherCrashNorAllocateWildly) {
  for (const auto& s : seeds()) {
    StreamMonitor monitor("FUZZ");
    for (std::size_t at = 8; at + 4 <= s.bytes.size(); ++at) {
      for (const std::uint32_t value : {0x00000000U, 0xFFFFFFFFU, 0x80000000U, 0x7FFFFFFFU, 0x7FFF7FFFU, 0x80008000U}) {
        Bytes bytes = s.bytes;
        for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (24U - 8U * i));
        feed(monitor, s, bytes);
      }
    }
    EXPECT_GT(undecodable(monitor), 0U);
  }
}

TEST(LcmFuzz, RandomMutationsOfEveryTypeAreTakenOrCounted) {
  constexpr int kRounds = 20000;
  std::mt19937 random(1);
  const auto all = seeds();
  StreamMonitor monitor("FUZZ");
  for (int round = 0; round < kRounds; ++round) {
    const auto& s = all[random() % all.size()];
    Bytes bytes = s.bytes;
    for (std::uint_fast32_t i = 0, n = 1 + random() % 8; i < n; ++i) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    if (random() % 4 == 0) bytes.resize(random() % (bytes.size() + 16));
    feed(monitor, s, bytes);
  }
  std::uint64_t heard = undecodable(monitor);
  for (std::size_t i = 0; i < StreamMonitor::kTopics; ++i) {
    const auto& count = monitor.count(static_cast<StreamMonitor::Topic>(i));
    heard += count.received + count.foreign;
  }
  EXPECT_EQ(heard, static_cast<std::uint64_t>(kRounds));
}

TEST(LcmFuzz, RandomBytesAfterARightFingerprintAreRefused) {
  std::mt19937 random(2);
  const auto all = seeds();
  StreamMonitor monitor("FUZZ");
  for (int round = 0; round < 5000; ++round) {
    const auto& s = all[random() % all.size()];
    Bytes bytes(s.bytes.begin(), s.bytes.begin() + 8);
    for (std::uint_fast32_t i = 0, n = random() % 200; i < n; ++i) bytes.push_back(static_cast<std::uint8_t>(random()));
    feed(monitor, s, bytes);
  }
  EXPECT_EQ(undecodable(monitor), 5000U);
}

TEST(LcmFuzz, AnOversizedMessageIsRefusedUnread) {
  const Bytes huge(drivers::kMaxMessageBytes + 1, 0);
  for (const auto& s : seeds()) EXPECT_FALSE(s.decode(huge));
}

}  // namespace
#endif
