#include "firmware_app/chain/makers.h"

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "firmware_app/config/core_config.h"

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

std::unique_ptr<Diagnosis::Past> past_of(const AppConfig& config, const core::CameraInfo& camera,
                                         const core::TrackFrame& keyframe,
                                         const core::ChannelDisplacement& displacement, const std::string& folder) {
  constexpr std::size_t kMostBytes = std::size_t{64} << 20U;  // an hour of 64 points at 30 frames a second
  const bool has_attitude = !config.camera.attitude_file.empty() || !config.camera.attitude_channel.empty();
  if (config.closure.adopt != ClosureAdopt::kAuto || has_attitude) return nullptr;
  const std::vector<core::ChannelInfo> spectra = displacement.spectra();
  Rebuild::Chain chain{welch_config(config.spectrum, spectra.size(), camera.rate_hz, displacement.n_witnesses()),
                       config.identification.period_hops, camera.rate_hz,
                       identifier_maker(config, camera, keyframe, spectra), motor_lines(config)};
  return std::make_unique<Diagnosis::Past>(
      Diagnosis::Past{std::move(chain), TrackStore(keyframe, kMostBytes, camera.frame_count, folder), keyframe});
}

}  // namespace app
