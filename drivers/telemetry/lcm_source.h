#pragma once

#include <memory>
#include <string>

#include "drivers/telemetry/lcm_datagrams.h"

namespace drivers {

// Source of LCM messages: UDP multicast through its own socket (reason: lcm_datagrams.h), event logs through its own
// reader (reason: event_log_reader.h), all other providers (memory, TCP) through LCM.
class LcmSource {
 public:
  // `pattern`: a regular expression for the wanted channels, as in LCM. Multicast and logs deliver all channels:
  // the receiver must check the name. Throws std::invalid_argument for a wrong URL, std::runtime_error if it cannot be
  // opened.
  LcmSource(const std::string& url, const std::string& pattern, LcmDatagrams::Receive receive);
  ~LcmSource();
  LcmSource(const LcmSource&) = delete;
  LcmSource& operator=(const LcmSource&) = delete;

  // Waits at most so long for a message and takes all that have arrived, up to a limit. False at the end of a log.
  [[nodiscard]] bool poll(int timeout_ms);

 private:
  struct Way;
  struct Multicast;
  struct Log;
  struct Library;
  std::unique_ptr<Way> way_;
};

}  // namespace drivers
