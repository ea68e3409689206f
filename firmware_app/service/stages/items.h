#pragma once

#include "core/types/displacement.h"
#include "core/types/run_record.h"
#include "core/types/track.h"
#include "firmware_app/chain/items.h"

namespace app {

// tracking -> publish: one frame as measured. Other items between stages are those of the chain (chain/items.h).
struct FrameRecord {
  core::TrackFrame tracks;
  core::DisplacementSample sample;
  core::AttitudeBatch attitude = {};  // received before it
};

}  // namespace app
