#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drivers {

// The structural modes of a service's estimates, over LCM, received by a thread of the listener. take(): one thread.
class ModesListener {
 public:
  static constexpr std::size_t kMost = 64;  // modes of an estimate
  struct Mode {
    double frequency_hz = 0.0, damping_ratio = 0.0;
  };

  // Throws std::invalid_argument for a wrong URL or prefix, std::runtime_error if nothing can be received.
  ModesListener(const std::string& url, const std::string& prefix);
  ~ModesListener();
  ModesListener(const ModesListener&) = delete;
  ModesListener& operator=(const ModesListener&) = delete;

  // Those of the newest whole estimate, by frequency; empty where none has come since the last call.
  [[nodiscard]] std::optional<std::vector<Mode>> take();

 private:
  struct Inbox;
  std::unique_ptr<Inbox> inbox_;
};

}  // namespace drivers
