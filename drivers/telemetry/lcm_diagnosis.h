#pragma once

#include <string>
#include <vector>

namespace drivers {

enum class FindingKind { kOk, kNote, kBad };

// One thing about the way of messages to and from this computer.
struct LcmFinding {
  FindingKind kind = FindingKind::kOk;
  std::string what;
  std::string remedy;  // a command or a setting; empty where nothing is to be done
};

// Looks at everything that multicast needs, first things first: loopback and route, interface, reach (ttl), a message
// sent and heard again, receive buffer. Sends a few messages on <prefix>_SELFTEST. Throws std::invalid_argument for a
// wrong URL or prefix.
[[nodiscard]] std::vector<LcmFinding> diagnose_lcm(const std::string& url, const std::string& channel_prefix);

}  // namespace drivers
