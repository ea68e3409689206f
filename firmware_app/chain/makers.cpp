#include "firmware_app/chain/makers.h"

#include <memory>
#include <utility>

namespace app {

ModeIdentification::MakeIdentifier identifier_maker(const AppConfig& config, const core::CameraInfo& camera,
                                                    const core::TrackFrame& keyframe,
                                                    std::vector<core::ChannelInfo> spectra) {
  return
      [&config, &camera, &keyframe, spectra = std::move(spectra)](double rate_hz, const CorrectionSet& correction_set) {
        core::CameraInfo amended = correction_set.applied(camera);
        amended.rate_hz = rate_hz;
        return std::make_unique<const ReadoutAwareIdentifier>(correction_set.applied(config, camera.rate_hz), amended,
                                                              keyframe, spectra);
      };
}

Diagnosis::MakeGeometry geometry_maker(const AppConfig& config, const core::CameraInfo& camera,
                                       const core::TrackFrame& keyframe) {
  return [&config, &camera, &keyframe](const CorrectionSet& correction_set) {
    return make_geometry(config, camera, keyframe, correction_set);
  };
}

}  // namespace app
