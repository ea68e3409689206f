#include "firmware_app/chain/observation.h"

#include <fmt/format.h>

#include "drivers/storage/calibration_file.h"
#include "firmware_app/config/core_config.h"

namespace app {
namespace {

core::CameraModel calibrated_camera(const AppConfig& config, const core::CameraInfo& camera,
                                    std::vector<std::string>& warnings) {
  const CalibrationConfig& c = config.calibration;
  if (!c.file.empty()) return drivers::read_calibration(c.file).camera;
  core::CameraModel model{c.fx, c.fy, c.cx, c.cy, c.distortion, c.model};
  if (model.calibrated()) return model;
  warnings.push_back(
      fmt::format("no calibration: the focal length is assumed to equal the image's width, {} px; angles and "
                  "lens coefficients are in units of it",
                  camera.width_px));
  model = {};
  model.fx = model.fy = camera.width_px;
  model.cx = 0.5 * (camera.width_px - 1), model.cy = 0.5 * (camera.height_px - 1);
  return model;
}

}  // namespace

ObservedPoints observed_points(const core::TrackFrame& keyframe, std::size_t n_regions, int points_per_region) {
  std::vector<std::size_t> n_seeded(n_regions, 0), n_met = n_seeded;
  for (const core::TrackPoint& point : keyframe.points) ++n_seeded[point.region];
  const auto most = static_cast<std::size_t>(points_per_region);
  ObservedPoints out;
  for (const core::TrackPoint& point : keyframe.points) {
    const std::size_t i = n_met[point.region]++, n = n_seeded[point.region];
    const bool is_observed = n <= most || (i + 1) * most / n > i * most / n;
    out.column_of_point.push_back(is_observed ? static_cast<int>(out.region_of_column.size()) : -1);
    if (is_observed) out.region_of_column.push_back(point.region);
  }
  return out;
}

DeclaredObservation declared_observation(const AppConfig& config, const core::CameraInfo& camera) {
  DeclaredObservation out;
  out.camera = calibrated_camera(config, camera, out.warnings);
  core::closure::ObservationRecord& record = out.record;
  record.rate_hz = config.camera.rate_hz > 0.0 ? config.camera.rate_hz : camera.rate_hz;
  record.width_px = camera.width_px, record.height_px = camera.height_px;
  const bool own = config.camera.readout_ms != 0.0;
  const double readout_s = own ? 1e-3 * config.camera.readout_ms : 1e-9 * static_cast<double>(camera.readout_ns);
  record.readout_frames = readout_s * record.rate_hz;
  record.readout_direction = own ? config.camera.readout_direction : camera.readout_direction;
  record.regions = config.regions;
  record.alpha_px = out.camera.fx, record.cx_px = out.camera.cx, record.cy_px = out.camera.cy;
  return out;
}

void name_motors(const AppConfig& config, const core::MotorLines& stated,
                 const core::closure::ObservationRecord& record, core::closure::ClosureResult& result) {
  const core::MotorLines motors = stated.empty() ? motor_lines(config) : stated;
  motors.name(result, record.rate_hz, static_cast<double>(record.n_frames()) / record.rate_hz);
}

}  // namespace app
