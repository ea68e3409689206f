#pragma once

#include "core/types/displacement.h"
#include "core/types/run_record.h"
#include "core/types/track.h"
#include "firmware_app/chain/items.h"

namespace app {

// tracking -> publish: one frame as it was seen. What else travels between stages is the chain's.
struct FrameRecord {
  core::TrackFrame tracks;
  core::DisplacementSample sample;
  core::AttitudeBatch attitude = {};  // heard before it
};

}  // namespace app
