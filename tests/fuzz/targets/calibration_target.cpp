#include <cmath>

#include "drivers/storage/calibration_file.h"
#include "drivers/storage/text_file.h"
#include "tests/fuzz/fuzz_target.h"

namespace tests::fuzz {
namespace {

void run(Bytes bytes) {
  drivers::Calibration calibration;
  try {
    calibration = drivers::parse_calibration(text_of(bytes), "fuzz");
  } catch (const drivers::FileError& error) {
    require(*error.what() != '\0', "a refusal says why");
    return;
  }
  const core::CameraModel& camera = calibration.camera;
  require(drivers::calibration_fault(camera, calibration.width_px, calibration.height_px).empty(),
          "what is taken has no fault");
  for (const double u : {0.0, 0.5 * calibration.width_px, 1.0 * calibration.width_px}) {
    for (const double v : {0.0, 0.5 * calibration.height_px, 1.0 * calibration.height_px}) {
      const core::Vector2 ideal = camera.undistort({u, v});
      if (std::isnan(ideal.u) || std::isnan(ideal.v)) continue;  // no ray there, which is allowed
      const core::Vector2 raw = camera.distort(ideal);
      require(std::isfinite(raw.u) && std::isfinite(raw.v), "a ray that is seen has a pixel");
    }
  }
  if (calibration.width_px > 0) require(drivers::scaled_camera(calibration, 640).calibrated(), "scaled, it is one");
  if (calibration.width_px == 0 || calibration.height_px == 0) return;  // such a file is never written
  const std::string text = drivers::calibration_text(calibration, {});
  const drivers::Calibration again = drivers::parse_calibration(text, "again");
  require(drivers::calibration_text(again, {}) == text, "written and read, it is the same");
}

const Registration kTarget("calibration", &run);

}  // namespace
}  // namespace tests::fuzz
