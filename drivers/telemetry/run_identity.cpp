#include "drivers/telemetry/run_identity.h"

#include <unistd.h>

#include <array>
#include <string>
#include <string_view>

#include "drivers/storage/checkpoint_file.h"
#include "rt/clock.h"

namespace drivers {
namespace {

std::uint64_t fnv1a(std::string_view text) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

std::uint64_t make_identity() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  const std::string text =
      boot_id() + '/' + host.data() + '/' + std::to_string(::getpid()) + '/' + std::to_string(rt::monotonic_ns());
  return fnv1a(text) | 1U;
}

}  // namespace

std::uint64_t run_identity() {
  static const std::uint64_t identity = make_identity();
  return identity;
}

}  // namespace drivers
