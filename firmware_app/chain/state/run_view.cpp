#include "firmware_app/chain/state/run_view.h"

#include "firmware_app/config/calibration.h"
#include "firmware_app/config/structure_scale.h"

namespace app {

RunState run_view(const AppConfig& config, const core::CameraInfo& camera,
                  const std::vector<core::ChannelInfo>& channels) {
  RunState view;
  view.config_hash = config.hash;
  view.rate_hz = camera.rate_hz;
  view.scale_mm_per_px = structure_scale(config, camera_model(config, camera)).mm_per_px;
  view.channels = channels;
  return view;
}

}  // namespace app
