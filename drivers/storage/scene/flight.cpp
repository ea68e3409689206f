#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/simulation/camera/recorded_motion.h"
#include "drivers/storage/flight_log.h"
#include "drivers/storage/scene/key.h"

namespace drivers {
namespace {

std::string beside(const std::string& folder, const std::string& path) {
  return (std::filesystem::path(folder) / path).lexically_normal().string();  // an absolute path is unchanged
}

}  // namespace

void load_flight(SceneFile& file, const std::string& folder) {
  const SceneFlight& use = file.flight;
  file.scene.flight = nullptr;
  if (use.file.empty()) {
    if (!use.imu.empty()) throw std::invalid_argument("simulation: flight: an imu without positions: give flight.file");
    return;
  }
  if (!(use.to_s > use.from_s)) {
    throw std::invalid_argument("simulation: flight: to_s does not lie after from_s: say which seconds to use");
  }
  try {
    const core::FlightPath path = read_flight_path(beside(folder, use.file), use.from_s, use.to_s);
    std::optional<core::FlightAttitude> attitude;
    if (!use.imu.empty()) {
      const double from_s = use.imu_from_s > 0.0 ? use.imu_from_s : use.from_s;
      attitude =
          read_flight_attitude(beside(folder, use.imu), use.imu_starts_at_s, from_s, from_s + use.to_s - use.from_s);
    }
    core::simulation::RecordedMotion motion = core::simulation::make_recorded_motion(
        path, attitude ? &*attitude : nullptr, {use.facing_deg, use.gimbal_residual, use.vibration_from_hz});
    for (auto* axis :
         {&motion.x_mm, &motion.y_mm, &motion.z_mm, &motion.pitch_rad, &motion.yaw_rad, &motion.roll_rad}) {
      for (double& value : *axis) value *= use.scale;
    }
    file.scene.flight = std::make_shared<const core::simulation::RecordedMotion>(std::move(motion));
  } catch (const FileError& error) {
    throw std::invalid_argument(std::string("flight: ") + error.what());
  }
}

}  // namespace drivers
