#pragma once

#include <vector>

#include <memory>
#include <string>

#include "core/geometry/channel_displacement.h"
#include "core/types/displacement.h"
#include "core/types/frame.h"
#include "core/types/track.h"
#include "firmware_app/chain/diagnosis.h"
#include "firmware_app/chain/mode_identification.h"
#include "firmware_app/config/config.h"

namespace app {

// Functions by which the chain's objects rebuild what a correction changes. The arguments must outlive the functions.
[[nodiscard]] ModeIdentification::MakeIdentifier identifier_maker(const AppConfig& config,
                                                                  const core::CameraInfo& camera,
                                                                  const core::TrackFrame& keyframe,
                                                                  std::vector<core::ChannelInfo> spectra);
[[nodiscard]] Diagnosis::MakeGeometry geometry_maker(const AppConfig& config, const core::CameraInfo& camera,
                                                     const core::TrackFrame& keyframe);

// What a run with closure.adopt: auto is measured again from; null: it is not (other values, and where attitudes are
// used, which the store does not keep). folder: of a file for its tracks; empty: memory. Throws std::bad_alloc.
[[nodiscard]] std::unique_ptr<Diagnosis::Past> past_of(const AppConfig& config, const core::CameraInfo& camera,
                                                       const core::TrackFrame& keyframe,
                                                       const core::ChannelDisplacement& displacement,
                                                       const std::string& folder = {});

}  // namespace app
