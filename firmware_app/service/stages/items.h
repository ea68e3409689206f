#pragma once

#include <cstdint>

#include "core/rotors/aircraft.h"
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
  core::AircraftBatch aircraft = {};
};

// tracking -> closure.
struct ShownFrame {
  core::TrackFrame tracks;
  std::uint32_t stride = 1;  // as DisplacementSample::stride
};

// tracking -> spectrum: from the sample of that number on, the run goes on as it was measured again.
struct Takeover {
  std::uint64_t from_sequence = 0;
  Rebuild* rebuilt = nullptr;
};

// tracking -> spectrum: a state of the aircraft received before the sample of that number.
struct AircraftUpdate {
  std::uint64_t before_sequence = 0;
  core::AircraftState state;
};

}  // namespace app
