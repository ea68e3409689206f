// For LD_PRELOAD. libcamera names a USB camera after the firmware's description of its controller, and refuses a camera
// whose controller has none, as the virtual one. This library supplies a name for that controller and changes nothing
// else.
#include <string>

namespace libcamera::sysfs {

std::string firmwareNodePath(const std::string& device) {
  return device.find("vhci_hcd") != std::string::npos ? "\\_SB_.PCI0.VHCI" : std::string();
}

}  // namespace libcamera::sysfs
