#pragma once

#include <string>

namespace drivers {

// Whether a message sent to this URL is received by this computer.
struct SelfTest {
  bool can_send = false;  // false: every message would be lost; there is no route to the group
  bool heard = false;     // false: no program on this computer can receive (others may, with ttl >= 1)
  std::string message;    // empty if received; otherwise what failed and how to correct it
};

// Sends an LCM message on <prefix>_SELFTEST a few times and waits up to 500 ms to receive one. It uses its own sockets,
// configured like LCM's, because LCM itself would block for ten seconds if nothing is received, and reports the fault
// on stderr only. Only udpm is tested; other providers count as received. Throws std::invalid_argument for an invalid
// URL.
[[nodiscard]] SelfTest run_lcm_self_test(const std::string& url, const std::string& channel_prefix);

// The same as one text: empty if the test succeeds. Never throws for an invalid URL: the text then explains it.
[[nodiscard]] std::string lcm_self_test(const std::string& url);

}  // namespace drivers
