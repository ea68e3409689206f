#pragma once

#include <string>

namespace drivers {

// Whether a message sent to this URL comes back to this computer.
struct SelfTest {
  bool can_send = false;  // false: every message would be lost; there is no network way to the group
  bool heard = false;     // false: nobody on this computer can listen (others may, with ttl >= 1)
  std::string message;    // empty when heard; otherwise what failed and how to mend it
};

// Sends an LCM message on <prefix>_SELFTEST a few times and waits up to 500 ms for one to come back. It uses sockets of
// its own, set up as LCM's are: LCM itself would block for ten seconds where nothing comes back, and says only on
// stderr what is wrong. Only udpm is tested; other providers count as heard. Throws std::invalid_argument for a URL
// that is wrong in itself.
[[nodiscard]] SelfTest run_lcm_self_test(const std::string& url, const std::string& channel_prefix);

// The same, as one text: empty when all is well. Never throws for a bad URL: that too is an explanation.
[[nodiscard]] std::string lcm_self_test(const std::string& url);

}  // namespace drivers
