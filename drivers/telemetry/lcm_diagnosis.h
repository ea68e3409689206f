#pragma once

#include <string>
#include <vector>

namespace drivers {

enum class FindingKind { kOk, kNote, kBad };

// One finding about the path of messages to and from this computer.
struct LcmFinding {
  FindingKind kind = FindingKind::kOk;
  std::string what;
  std::string remedy;  // a command or a setting; empty: nothing needs to be done
};

// Checks everything that multicast needs, in order of dependence: loopback and route, interface, reach (ttl), a message
// sent and received again, receive buffer. Sends a few messages on <prefix>_SELFTEST. Throws std::invalid_argument for
// a wrong URL or prefix.
[[nodiscard]] std::vector<LcmFinding> diagnose_lcm(const std::string& url, const std::string& channel_prefix);

}  // namespace drivers
