#pragma once

#include "core/types/closure_result.h"
#include "firmware_app/chain/correction_set.h"
#include "firmware_app/replay/tracks_record.h"

namespace app {

// An effect of the observation level that is removed from the points of a whole record: a constant of camera or
// tracker, in the catalogue and without a rival. Rules as in core::closure::Adoption, except that no second report is
// needed.
[[nodiscard]] bool is_corrected(const core::closure::ClosureStep& step);

// Corrections that a result makes in every frame of its record, the keyframe included. No words: no correction.
[[nodiscard]] CorrectionSet corrections_of(const core::closure::ClosureResult& result, const core::CameraModel& camera);

// Keeps at most so many points per region, spread evenly over them, as the service does.
[[nodiscard]] TracksRecord thinned(TracksRecord record, int points_per_region);
// Points that it keeps, of those in the first frame.
[[nodiscard]] std::size_t n_thinned(const drivers::TracksFile& file, int points_per_region);

}  // namespace app
