#pragma once

#include <stdexcept>

namespace drivers {

// The source named in the configuration does not exist: no such file, or no driver of that kind in this build.
// A separate class, because the service has a separate exit code for it.
class DeviceMissing : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace drivers
