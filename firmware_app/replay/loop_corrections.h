#pragma once

#include "core/types/closure_result.h"
#include "firmware_app/chain/correction_set.h"
#include "firmware_app/replay/tracks_record.h"

namespace app {

// An effect of the observation level that is taken out of the points of a whole record: a constant of camera or tracker,
// with a name and without a rival. The rules are those of core::closure::Adoption; the record is its own confirmation.
[[nodiscard]] bool is_corrected(const core::closure::ClosureStep& step);

// What a result takes out of every frame of its record, the keyframe included. No words: nothing.
[[nodiscard]] CorrectionSet corrections_of(const core::closure::ClosureResult& result, const core::CameraModel& camera);

// At most so many points per region, evenly over them, as the service analyses.
[[nodiscard]] TracksRecord thinned(TracksRecord record, int points_per_region);

}  // namespace app
