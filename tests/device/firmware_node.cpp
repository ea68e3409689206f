// For LD_PRELOAD. libcamera names a USB camera after the firmware's description of the controller it hangs on, and
// refuses one whose controller has none, as the virtual one. This gives that controller a name; nothing else is
// touched.
#include <string>

namespace libcamera::sysfs {

std::string firmwareNodePath(const std::string& device) {
  return device.find("vhci_hcd") != std::string::npos ? "\\_SB_.PCI0.VHCI" : std::string();
}

}  // namespace libcamera::sysfs
