#include "firmware_app/chain/makers.h"

#include <memory>
#include <utility>

namespace app {

ModeIdentification::MakeIdentifier identifier_maker(const AppConfig& config, const core::CameraInfo& camera,
                                                    const core::TrackFrame& keyframe,
                                                    std::vector<core::ChannelInfo> spectra) {
  return [&config, &camera, &keyframe, spectra = std::move(spectra)](double rate_hz, const Amendment& amendment) {
    core::CameraInfo amended = amendment.applied(camera);
    amended.rate_hz = rate_hz;
    return std::make_unique<const ReadoutUse>(amendment.applied(config, camera.rate_hz), amended, keyframe, spectra);
  };
}

Diagnosis::MakeGeometry geometry_maker(const AppConfig& config, const core::CameraInfo& camera,
                                       const core::TrackFrame& keyframe) {
  return [&config, &camera, &keyframe](const Amendment& amendment) {
    return make_geometry(config, camera, keyframe, amendment);
  };
}

}  // namespace app
