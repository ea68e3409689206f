#include "drivers/telemetry/lcm_datagrams.h"
#include "tests/fuzz/fuzz_target.h"

namespace tests::fuzz {
namespace {

// Datagrams one after the other: a byte for the sender, a length, the bytes.
void run(Bytes bytes) {
  using drivers::LcmDatagrams;
  std::uint64_t n_whole = 0, n_datagrams = 0;
  LcmDatagrams datagrams([&](std::string_view channel, const void* data, std::size_t n_bytes) {
    ++n_whole;
    require(channel.size() <= LcmDatagrams::kLongestChannel, "a channel's name is bounded");
    require(channel.find('\0') == channel.npos, "a channel's name holds no zero");
    require(n_bytes <= LcmDatagrams::kMostBytes, "a message is bounded");
    const auto* at = static_cast<const std::uint8_t*>(data);
    std::uint8_t sum = 0;  // reads every byte
    for (std::size_t i = 0; i < n_bytes; ++i) sum = static_cast<std::uint8_t>(sum + at[i]);
    static_cast<void>(sum);
  });
  Input input(bytes);
  while (!input.empty() && n_datagrams < 256) {
    const std::uint64_t sender = input.byte() % 4U;
    const Exact datagram(input.piece());
    datagrams.take(datagram.data(), datagram.size(), sender);
    ++n_datagrams;
  }
  require(n_whole + datagrams.n_malformed() <= n_datagrams, "a datagram ends one message at most");
}

const Registration kTarget("datagrams", &run);

}  // namespace
}  // namespace tests::fuzz
