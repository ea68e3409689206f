#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "tests/fuzz/fuzz_target.h"
#include "tests/support/places.h"

namespace {

namespace fs = std::filesystem;
using tests::fuzz::Target;

std::vector<fs::path> kept_inputs(const std::string& target) {
  std::vector<fs::path> out;
  const fs::path folder = tests::source_path("tests/fuzz/corpus/" + target);
  if (!fs::is_directory(folder)) return out;
  for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::uint8_t> bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void expect_to_hold(const Target& target, const std::vector<std::uint8_t>& bytes, const std::string& what) {
  try {
    target.run(bytes);
  } catch (const std::exception& error) {
    ADD_FAILURE() << target.name << ", " << what << ": " << error.what();
  }
}

class FuzzCorpus : public ::testing::TestWithParam<Target> {};

// Every kept input: seeds, and findings of a fuzzer.
TEST_P(FuzzCorpus, HoldsForEveryKeptInput) {
  const auto inputs = kept_inputs(GetParam().name);
  EXPECT_GE(inputs.size(), 3U) << "tests/fuzz/corpus/" << GetParam().name;
  for (const fs::path& path : inputs) expect_to_hold(GetParam(), bytes_of(path), path.filename().string());
}

TEST_P(FuzzCorpus, HoldsForEveryTruncationOfAShortInput) {
  expect_to_hold(GetParam(), {}, "nothing");
  for (const fs::path& path : kept_inputs(GetParam().name)) {
    std::vector<std::uint8_t> bytes = bytes_of(path);
    for (std::size_t n = std::min<std::size_t>(bytes.size(), 150); n > 0; --n) {
      bytes.resize(n - 1);
      expect_to_hold(GetParam(), bytes, path.filename().string() + " cut to " + std::to_string(n - 1));
    }
  }
}

// Substitute for a compiler without a fuzzer: bytes changed at random, the same in every run.
TEST_P(FuzzCorpus, HoldsForDamagedInputs) {
  constexpr std::uint32_t kSeeds = 40;
  for (const fs::path& path : kept_inputs(GetParam().name)) {
    const std::vector<std::uint8_t> whole = bytes_of(path);
    for (std::uint32_t seed = 1; seed <= kSeeds && whole.size() > 1; ++seed) {
      std::mt19937 random(seed);
      std::vector<std::uint8_t> bytes = whole;
      // The first byte often selects the kind of input.
      for (std::uint_fast32_t i = 0, n = 1 + random() % 6; i < n; ++i)
        bytes[1 + random() % (bytes.size() - 1)] = static_cast<std::uint8_t>(random());
      expect_to_hold(GetParam(), bytes, path.filename().string() + ", seed " + std::to_string(seed));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzCorpus, ::testing::ValuesIn(tests::fuzz::targets()),
                         [](const auto& target) { return target.param.name; });

}  // namespace
