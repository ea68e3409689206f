#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"
#include "core/types/track.h"

namespace app {

// What travels between stages, where it is more than one core type.

// tracking -> publish: one frame as it was seen.
struct FrameRecord {
  core::TrackFrame tracks;
  core::DisplacementSample sample;
};

// spectrum -> identification.
struct SpectrumSnapshot {
  core::CpsdSums sums;
  std::uint64_t number = 0;    // 0, 1, 2, ... in stream time
  std::int64_t t_last_ns = 0;  // time stamp of the newest sample in the sums
  bool final = false;          // the record has ended
  core::ReadoutEstimate readout;
};

// identification -> publish.
struct IdentificationResult {
  core::ModalEstimate estimate;
  core::CpsdSums sums;
};

// spectrum, identification -> checkpoint: all that a later run needs to go on. Sized once.
struct StateBytes {
  std::vector<std::uint8_t> bytes;
  std::size_t n_used = 0;
};

}  // namespace app
