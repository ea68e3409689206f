#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace core {

// State of an object as bytes in the machine's order (little-endian on x86-64 and arm64), to continue bit-identically.
// One function describes the state to writer and reader: `archive.value(x)`, `archive.array(v)`.

// Writes into memory of a fixed size; does not allocate. If the memory is too small, ok() is false.
class StateWriter {
 public:
  explicit StateWriter(std::span<std::uint8_t> room) noexcept : room_(room) {}

  template <class T>
  void value(const T& x) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&x, sizeof x);
  }
  template <class T>
  void array(const std::vector<T>& v) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    value(static_cast<std::uint64_t>(v.size()));
    raw(v.data(), v.size() * sizeof(T));
  }

  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] std::size_t n_used() const noexcept { return used_; }

 private:
  void raw(const void* data, std::size_t n_bytes) noexcept {
    ok_ = ok_ && n_bytes <= room_.size() - used_;
    if (!ok_ || n_bytes == 0) return;
    std::memcpy(room_.data() + used_, data, n_bytes);
    used_ += n_bytes;
  }

  std::span<std::uint8_t> room_;
  std::size_t used_ = 0;
  bool ok_ = true;
};

// Reads from untrusted bytes: if an array has another length than the object's, or the bytes end too early, ok()
// becomes false and nothing more is read.
class StateReader {
 public:
  explicit StateReader(std::span<const std::uint8_t> bytes) noexcept : bytes_(bytes) {}

  template <class T>
  void value(T& x) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&x, sizeof x);
  }
  // A byte that is neither 0 nor 1 must not be copied to a bool: reading it would be undefined behaviour.
  void value(bool& x) noexcept {
    std::uint8_t byte = x ? 1 : 0;
    raw(&byte, sizeof byte);
    x = byte != 0;
  }
  template <class T>
  void array(std::vector<T>& v) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t n = 0;
    value(n);
    ok_ = ok_ && n == v.size();
    raw(v.data(), v.size() * sizeof(T));
  }

  void fail() noexcept { ok_ = false; }
  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] std::span<const std::uint8_t> rest() const noexcept { return bytes_; }

 private:
  void raw(void* data, std::size_t n_bytes) noexcept {
    ok_ = ok_ && n_bytes <= bytes_.size();
    if (!ok_ || n_bytes == 0) return;
    std::memcpy(data, bytes_.data(), n_bytes);
    bytes_ = bytes_.subspan(n_bytes);
  }

  std::span<const std::uint8_t> bytes_;
  bool ok_ = true;
};

}  // namespace core
