#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/types/attitude.h"

namespace drivers {

// Sends attitudes (attitude_t) on one LCM channel, for a service whose camera.attitude_channel names it. One thread.
class AttitudeSender {
 public:
  // Throws std::invalid_argument for a wrong URL or channel, std::runtime_error where the network cannot be used.
  AttitudeSender(const std::string& url, const std::string& channel);
  ~AttitudeSender();
  AttitudeSender(const AttitudeSender&) = delete;
  AttitudeSender& operator=(const AttitudeSender&) = delete;

  bool send(const core::AttitudeSample& sample);  // false: not sent
  [[nodiscard]] std::uint64_t n_failed() const noexcept { return n_failed_; }

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
  std::string channel_;
  std::uint64_t n_failed_ = 0;
};

}  // namespace drivers
