#include <cmath>
#include <cstdint>

#include "drivers/mavlink/mavlink_companion.h"
#include "tests/fuzz/fuzz_target.h"

namespace tests::fuzz {
namespace {

// Any bytes from a link, in datagrams and as a stream: no attitude that is none, no frame without its checksum.
void run(Bytes bytes) {
  for (const bool datagrams : {true, false}) {
    drivers::MavlinkCompanion companion({.of_gimbal = false, .datagrams = datagrams},
                                        [](const core::AttitudeSample& sample) {
                                          double squares = 0.0;
                                          for (const double part : sample.wxyz) squares += part * part;
                                          require(squares > 0.2 && squares < 5.0, "an attitude is a rotation");
                                          require(std::isfinite(sample.t_s), "its time is one");
                                        });
    std::int64_t now_ns = 1'000'000'000;
    for (std::size_t at = 0; at < bytes.size(); at += 97, now_ns += 30'000'000) {
      (void)companion.due(now_ns);
      companion.take(
          {reinterpret_cast<const std::uint8_t*>(bytes.data()) + at, std::min<std::size_t>(97, bytes.size() - at)},
          now_ns);
    }
    require(companion.stream().skipped_bytes <= bytes.size(), "no byte is skipped twice");
    for (const double hz : companion.motors_hz()) require(std::isfinite(hz), "a motor's speed is a number");
  }
}

const Registration kTarget("mavlink", &run);

}  // namespace
}  // namespace tests::fuzz
