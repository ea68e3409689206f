#pragma once

#include <memory>
#include <numeric>
#include <vector>

#include "firmware_app/chain/correction_set.h"
#include "firmware_app/chain/missing_effect_search.h"
#include "tests/support/swaying_record.h"

namespace test_support {

inline constexpr double kWindow_s = 40.0, kPeriod_s = 30.0, kDelay_s = 10.0;

// Residual diagnosis of a swaying record whose readout time and lens are not declared.
inline app::MissingEffectSearchConfig loop_over(const core::closure::ObservationRecord& record, bool adopts) {
  core::closure::ObservationRecord declared = record;
  declared.readout_frames = 0.0;
  const core::CameraModel camera{record.alpha_px, record.alpha_px, record.cx_px, record.cy_px, {}};
  const core::closure::RecentTracks recent(declared, camera, record.region_of_point,
                                           static_cast<std::size_t>(kWindow_s * record.rate_hz));
  std::vector<int> columns(record.region_of_point.size());
  std::iota(columns.begin(), columns.end(), 0);
  std::vector<core::Vector2> keyframe_px;
  for (const core::TrackPoint& p : track_frame(record, 0).points) keyframe_px.push_back({p.u_px, p.v_px});
  return {recent, camera, columns, keyframe_px, record.rate_hz, kPeriod_s, kDelay_s, adopts, 0.0};
}

// A null geometry: nothing is measured with it.
inline std::unique_ptr<app::Geometry> no_geometry(const core::closure::ObservationRecord& record) {
  core::ChannelDisplacementConfig config;
  config.regions = record.regions;
  const core::TrackFrame keyframe = track_frame(record, 0);
  return std::make_unique<app::Geometry>(
      app::Geometry{{config, keyframe}, {{{record.regions.size(), {}, {}}, record.rate_hz}, keyframe}});
}

}  // namespace test_support
