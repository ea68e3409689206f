#include <cstdlib>

#include "tests/fuzz/fuzz_target.h"

// Called by libFuzzer with each input: runs the one target that is linked in.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t n_bytes) {
  const auto& targets = tests::fuzz::targets();
  if (targets.size() != 1) std::abort();
  targets.front().run({data, n_bytes});
  return 0;
}
