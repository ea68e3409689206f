#include "drivers/telemetry/run_identity.h"

#include <unistd.h>

#include <array>
#include <string>

#include "core/types/fnv1a.h"
#include "drivers/storage/checkpoint_file.h"
#include "rt/clock.h"

namespace drivers {
namespace {

std::uint64_t make_identity() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  const std::string text =
      boot_id() + '/' + host.data() + '/' + std::to_string(::getpid()) + '/' + std::to_string(rt::monotonic_ns());
  return core::fnv1a(text) | 1U;
}

}  // namespace

std::uint64_t run_identity() {
  static const std::uint64_t identity = make_identity();
  return identity;
}

}  // namespace drivers
