#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace test_support {

template <class T>
std::string big_endian(T value) {
  std::string out(sizeof(T), '\0');
  std::memcpy(out.data(), &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::little) out = std::string(out.rbegin(), out.rend());
  return out;
}

// One key of GoPro's metadata: four letters, type, bytes a row, number of rows, the rows padded to four bytes.
inline std::string gpmf_item(const std::string& key, char type, std::size_t row_bytes, std::string data) {
  const auto n_rows = static_cast<std::uint16_t>(data.size() / row_bytes);
  std::string out = key + type + static_cast<char>(row_bytes) + big_endian(n_rows) + data;
  while (out.size() % 4 != 0) out += '\0';
  return out;
}
inline std::string gpmf_text(const std::string& key, const std::string& text) { return gpmf_item(key, 'c', 1, text); }

inline std::span<const std::uint8_t> span_of(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

}  // namespace test_support
