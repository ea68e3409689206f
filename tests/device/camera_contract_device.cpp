// The contract suite of all drivers (tests/support/camera_contract.h) on the device that HOVERMODAL_CAMERA names, as
// "v4l2 NODE WxH" or "libcamera NAME WxH". Run inside the virtual machine.
#include <cstdlib>
#include <sstream>

#include "drivers/camera/camera_factory.h"
#include "tests/support/camera_contract.h"

namespace test_support {
namespace {

std::unique_ptr<drivers::Camera> device_camera() {
  const char* text = std::getenv("HOVERMODAL_CAMERA");
  std::istringstream words(text != nullptr ? text : "");
  drivers::CameraOptions options;
  std::string driver;
  char by = 'x';
  words >> driver >> options.source >> options.width_px >> by >> options.height_px;
  options.kind = driver == "libcamera" ? drivers::CameraKind::kLibcamera : drivers::CameraKind::kV4l2;
  return drivers::make_camera(options);
}

INSTANTIATE_TEST_SUITE_P(Device, CameraContract, ::testing::Values(ContractCamera{"device", device_camera, true}),
                         contract_name);

}  // namespace
}  // namespace test_support
