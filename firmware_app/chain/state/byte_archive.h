#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace app {

// Plain values and lists of them as bytes in the machine's own order, for files written and read by one machine. One
// function describes an object to reader and writer: `archive.value(x)`, `archive.list(v)`. (core::StateWriter, of
// fixed size, is for the run path.)

// Grows as needed.
class ByteWriter {
 public:
  std::vector<std::uint8_t> bytes;

  template <class T>
  void value(const T& x) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* at = reinterpret_cast<const std::uint8_t*>(&x);
    bytes.insert(bytes.end(), at, at + sizeof x);
  }
  template <class Container>
  void list(const Container& items) {
    using Item = typename Container::value_type;
    static_assert(std::is_trivially_copyable_v<Item>);
    value(static_cast<std::uint64_t>(items.size()));
    const auto* at = reinterpret_cast<const std::uint8_t*>(items.data());
    bytes.insert(bytes.end(), at, at + items.size() * sizeof(Item));
  }
};

// Throws std::runtime_error where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  void value(T& x) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (bytes_.size() < sizeof x) throw std::runtime_error("it ends too early");
    std::memcpy(&x, bytes_.data(), sizeof x);
    bytes_ = bytes_.subspan(sizeof x);
  }
  // A byte that is neither 0 nor 1 must not become a bool: reading it is undefined.
  void value(bool& x) {
    std::uint8_t byte = 0;
    value(byte);
    x = byte != 0;
  }
  template <class Container>
  void list(Container& items) {
    using Item = typename Container::value_type;
    static_assert(std::is_trivially_copyable_v<Item>);
    const std::size_t n = count();
    if (bytes_.size() / sizeof(Item) < n) throw std::runtime_error("it ends too early");
    items.resize(n);
    if (n > 0) std::memcpy(items.data(), bytes_.data(), n * sizeof(Item));
    bytes_ = bytes_.subspan(n * sizeof(Item));
  }
  [[nodiscard]] std::size_t count() {
    constexpr std::uint64_t kMostItems = 1'000'000'000;
    std::uint64_t n = 0;
    value(n);
    if (n > kMostItems || n > bytes_.size()) throw std::runtime_error("it ends too early");
    return static_cast<std::size_t>(n);
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace app
