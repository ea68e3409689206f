#include "firmware_app/chain/correction_set.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware_app/chain/readout_aware_identifier.h"
#include "firmware_app/config/core_config.h"

namespace app {

namespace {
// Least standard deviation of a readout time estimated from a record, whatever its fit states: rows have finite height.
constexpr double kLeastSigma_frames = 0.002;
}  // namespace

AppConfig CorrectionSet::applied(const AppConfig& config, double rate_hz) const {
  AppConfig out = config;
  if (added_readout_frames != 0.0)
    out.camera.readout_sigma_ms = 1e3 * std::max(kLeastSigma_frames, readout_sigma_frames) / rate_hz;
  return out;
}

core::CameraInfo CorrectionSet::applied(const core::CameraInfo& camera) const {
  core::CameraInfo out = camera;
  out.readout_ns += std::llround(1e9 * added_readout_frames / camera.rate_hz);
  return out;
}

std::unique_ptr<Geometry> make_geometry(const AppConfig& config, const core::CameraInfo& camera,
                                        const core::TrackFrame& keyframe, const CorrectionSet& correction_set) {
  const AppConfig amended = correction_set.applied(config, camera.rate_hz);
  core::ChannelDisplacementConfig displacement = displacement_config(amended, correction_set.applied(camera));
  displacement.places = correction_set.places;
  core::ReadoutEstimator::Config readout = readout_config(amended, correction_set.applied(camera));
  readout.shear.places = correction_set.places;
  return std::make_unique<Geometry>(Geometry{core::ChannelDisplacement(std::move(displacement), keyframe),
                                             core::ReadoutEstimator(readout, keyframe)});
}

}  // namespace app
