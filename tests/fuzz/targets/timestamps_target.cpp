#include <cmath>
#include <stdexcept>

#include "drivers/camera/recording/timestamp_file.h"
#include "tests/fuzz/memory_file.h"

namespace tests::fuzz {
namespace {

void run(Bytes bytes) {
  const MemoryFile file(bytes);
  std::vector<std::int64_t> stamps_ns;
  try {
    stamps_ns = drivers::read_timestamp_file(file.path());
  } catch (const std::runtime_error& error) {
    require(*error.what() != '\0', "a refusal says why");
    return;
  }
  require(!stamps_ns.empty(), "there are stamps");
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) require(stamps_ns[i] > stamps_ns[i - 1], "stamps increase");
  if (stamps_ns.size() > 1) {
    const double rate_hz = drivers::mean_rate_hz(stamps_ns);
    require(std::isfinite(rate_hz) && rate_hz > 0.0, "the rate is one");
  }
}

const Registration kTarget("timestamps", &run);

}  // namespace
}  // namespace tests::fuzz
