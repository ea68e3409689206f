#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/lcm_datagrams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using Bytes = std::vector<std::uint8_t>;

void put(Bytes& out, std::uint64_t value, unsigned n_bytes) {
  for (unsigned i = n_bytes; i > 0; --i) out.push_back(static_cast<std::uint8_t>(value >> (8 * (i - 1))));
}

Bytes begin(std::string_view magic, std::size_t room) {
  Bytes out;
  out.reserve(room + 64);
  for (const char c : magic) out.push_back(static_cast<std::uint8_t>(c));
  return out;
}

void append(Bytes& out, const Bytes& more) {
  for (const std::uint8_t byte : more) out.push_back(byte);
}
void append_name(Bytes& out, const std::string& channel) {
  for (const char c : channel) out.push_back(static_cast<std::uint8_t>(c));
  out.push_back(0);
}

Bytes short_message(const std::string& channel, const Bytes& data) {
  Bytes out = begin("LC02", channel.size() + data.size());
  put(out, 1, 4);
  append_name(out, channel);
  append(out, data);
  return out;
}

struct Fragment {
  std::uint32_t number = 1, size = 0, offset = 0;
  std::uint16_t index = 0, n_fragments = 1;
};

Bytes fragment(const Fragment& f, const std::string& channel, const Bytes& data) {
  Bytes out = begin("LC03", channel.size() + data.size());
  put(out, f.number, 4);
  put(out, f.size, 4);
  put(out, f.offset, 4);
  put(out, f.index, 2);
  put(out, f.n_fragments, 2);
  if (f.index == 0) append_name(out, channel);
  append(out, data);
  return out;
}

Bytes numbers(std::size_t n) {
  Bytes out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<std::uint8_t>(i % 251);
  return out;
}

std::vector<Bytes> fragments(std::uint32_t number, const Bytes& data, std::size_t each) {
  std::vector<Bytes> out;
  const std::size_t n = (data.size() + each - 1) / each;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t begin = i * each, end = std::min(data.size(), begin + each);
    out.push_back(fragment(
        {number, static_cast<std::uint32_t>(data.size()), static_cast<std::uint32_t>(begin),
         static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(n)},
        "BIG",
        Bytes(data.begin() + static_cast<std::ptrdiff_t>(begin), data.begin() + static_cast<std::ptrdiff_t>(end))));
  }
  return out;
}

class LcmDatagrams : public ::testing::Test {
 protected:
  // In a block of exactly its size, so that a sanitizer detects the first read beyond it.
  void take(const Bytes& bytes, std::uint64_t sender = 1) {
    const std::unique_ptr<std::uint8_t[]> exact(new std::uint8_t[bytes.size()]);
    std::copy(bytes.begin(), bytes.end(), exact.get());
    datagrams_.take(exact.get(), bytes.size(), sender);
  }
  std::vector<std::pair<std::string, Bytes>> got_;
  drivers::LcmDatagrams datagrams_{[this](std::string_view channel, const void* data, std::size_t n_bytes) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    got_.emplace_back(channel, Bytes(bytes, bytes + n_bytes));
  }};
};

TEST_F(LcmDatagrams, HandsOverAShortMessage) {
  take(short_message("A.b", {1, 2, 3}));
  take(short_message("EMPTY", {}));
  ASSERT_EQ(got_.size(), 2U);
  EXPECT_EQ(got_[0], std::pair(std::string("A.b"), Bytes{1, 2, 3}));
  EXPECT_TRUE(got_[1].second.empty());
}

TEST_F(LcmDatagrams, PutsFragmentsTogetherInAnyOrderAndFromSeveralSenders) {
  const Bytes data = numbers(10000);
  auto parts = fragments(7, data, 1400);
  std::reverse(parts.begin(), parts.end());
  for (const Bytes& part : parts) {
    take(part, 1);
    take(part, 2);
    take(part, 2);  // repeated
  }
  ASSERT_EQ(got_.size(), 2U);
  EXPECT_EQ(got_[0], std::pair(std::string("BIG"), data));
  EXPECT_EQ(got_[1].second, data);
  EXPECT_EQ(datagrams_.n_malformed(), 0U);
}

TEST_F(LcmDatagrams, AMessageThatLacksAFragmentIsForgottenInTheEnd) {
  for (std::uint32_t number = 0; number < 100; ++number) take(fragments(number, numbers(3000), 1400)[1]);
  EXPECT_TRUE(got_.empty());
  EXPECT_EQ(datagrams_.n_incomplete(), 100U - drivers::LcmDatagrams::kMostOpen);
}

TEST_F(LcmDatagrams, CountsWhatCannotBe) {
  const std::vector<Bytes> bad{{},
                               {'L', 'C'},
                               {'L', 'C', '0', '2', 0, 0, 0},
                               {'L', 'C', '0', '4', 0, 0, 0, 1, 'A', 0},
                               {'L', 'C', '0', '2', 0, 0, 0, 1},                // no name
                               {'L', 'C', '0', '2', 0, 0, 0, 1, 'A', 'B'},      // no end of the name
                               short_message(std::string(64, 'A'), {1}),        // too long a name
                               fragment({1, 10, 0, 0, 0}, "A", {1}),            // of no fragments
                               fragment({1, 10, 0, 3, 2}, "A", {1}),            // beyond the last
                               fragment({1, 10, 8, 1, 2}, "A", {1, 2, 3}),      // over the end
                               fragment({1, 10, 0xFFFFFFFFU, 1, 2}, "A", {1}),  // far over the end
                               fragment({1, 0xFFFFFFFFU, 0, 1, 2}, "A", {1}),   // four gigabytes
                               fragment({1, 3, 0, 0, 65535}, "A", {1, 2, 3}),   // more fragments than bytes
                               fragment({1, 10, 0, 0, 1}, "A", {1, 2, 3}),      // shorter than stated
                               Bytes(19, 'L')};
  for (const Bytes& bytes : bad) take(bytes);
  EXPECT_TRUE(got_.empty());
  EXPECT_EQ(datagrams_.n_malformed(), bad.size());
}

TEST_F(LcmDatagrams, FragmentsThatContradictTheFirstBeginAnew) {
  take(fragment({5, 20, 0, 0, 2}, "A", Bytes(10, 1)));
  take(fragment({5, 30, 10, 1, 2}, "A", Bytes(10, 2)));
  EXPECT_TRUE(got_.empty());
  EXPECT_EQ(datagrams_.n_incomplete(), 1U);
}

TEST_F(LcmDatagrams, AnyBytesAreTakenOrCounted) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937 random(seed);
    const auto good = fragments(1, numbers(4000), 1400);
    for (int i = 0; i < 20000; ++i) {
      Bytes bytes = random() % 2 == 0 ? good[random() % good.size()] : short_message("CHANNEL", numbers(random() % 50));
      for (std::uint_fast32_t k = 0, n = random() % 6; k < n; ++k)
        bytes[random() % std::min<std::size_t>(bytes.size(), 40)] = static_cast<std::uint8_t>(random());
      if (random() % 4 == 0) bytes.resize(random() % bytes.size());
      take(bytes, random() % 3);
    }
  }
  EXPECT_GT(got_.size(), 0U);
  EXPECT_GT(datagrams_.n_malformed(), 0U);
}

}  // namespace
#endif
