#pragma once

#include <cstdint>
#include <string_view>

namespace core {

// FNV-1a, 64 bit: identity of a text, no protection against forgery.
[[nodiscard]] constexpr std::uint64_t fnv1a(std::string_view text) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

}  // namespace core
