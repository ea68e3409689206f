#pragma once

#include <memory>
#include <string>

#include "drivers/telemetry/lcm_datagrams.h"

namespace drivers {

// Where LCM messages come from: UDP multicast through a socket of our own (lcm_datagrams.h says why), event logs
// through a reader of our own (event_log_reader.h says why), everything else (memory, TCP) through LCM. One thread.
class LcmSource {
 public:
  // `pattern`: a regular expression for the channels wanted, as LCM takes it. Multicast and logs bring all channels:
  // the receiver looks at the name. Throws std::invalid_argument for a wrong URL, std::runtime_error when it cannot be
  // opened.
  LcmSource(const std::string& url, const std::string& pattern, LcmDatagrams::Receive receive);
  ~LcmSource();
  LcmSource(const LcmSource&) = delete;
  LcmSource& operator=(const LcmSource&) = delete;

  // Waits so long for a message and takes all that are there, within reason. False at the end of a log.
  [[nodiscard]] bool poll(int timeout_ms);

 private:
  struct Way;
  struct Multicast;
  struct Log;
  struct Library;
  std::unique_ptr<Way> way_;
};

}  // namespace drivers
