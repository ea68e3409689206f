#pragma once

#include <stdexcept>

namespace drivers {

// The source named in the configuration is not there: no such file, or this build has no driver of that kind.
// A class of its own because the service answers it with its own exit code.
class DeviceMissing : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace drivers
