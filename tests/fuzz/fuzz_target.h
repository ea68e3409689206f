#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tests::fuzz {

using Bytes = std::span<const std::uint8_t>;

// A property that every result must have, whatever the input, is violated. Never caught by a target: libFuzzer stops at
// it, and the
// ordinary test of the corpus fails.
class Violation : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};
inline void require(bool holds, const char* what) {
  if (!holds) throw Violation(what);
}

// A function that accepts any bytes. Each targets/<name>_target.cpp registers one: alone in a libFuzzer program
// (fuzz_main.cpp), all together in corpus_test.cpp.
struct Target {
  std::string name;
  void (*run)(Bytes) = nullptr;
};
[[nodiscard]] inline std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}
struct Registration {
  Registration(const char* name, void (*run)(Bytes)) { targets().push_back({name, run}); }
};

// Splits an input into parts; missing parts read as zero or empty.
class Input {
 public:
  explicit Input(Bytes bytes) : rest_(bytes) {}

  [[nodiscard]] bool empty() const noexcept { return rest_.empty(); }
  [[nodiscard]] std::uint8_t byte() { return empty() ? std::uint8_t{0} : take(1)[0]; }
  [[nodiscard]] Bytes take(std::size_t n) {
    const Bytes out = rest_.first(std::min(n, rest_.size()));
    rest_ = rest_.subspan(out.size());
    return out;
  }
  // A piece preceded by its length, 16 bits.
  [[nodiscard]] Bytes piece() {
    const std::size_t high = byte(), low = byte();
    return take(high << 8U | low);
  }
  [[nodiscard]] Bytes rest() { return take(rest_.size()); }

 private:
  Bytes rest_;
};

[[nodiscard]] inline std::string text_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

// The bytes in a block of exactly their size, so that a sanitizer detects the first read beyond them.
class Exact {
 public:
  explicit Exact(Bytes bytes) : size_(bytes.size()), data_(new std::uint8_t[size_]) {
    if (size_ > 0) std::memcpy(data_.get(), bytes.data(), size_);
  }
  [[nodiscard]] const std::uint8_t* data() const noexcept { return data_.get(); }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

 private:
  std::size_t size_;
  std::unique_ptr<std::uint8_t[]> data_;
};

}  // namespace tests::fuzz
