#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/rotors/aircraft.h"
#include "core/types/cpsd.h"
#include "core/types/modal_estimate.h"
#include "core/types/readout.h"
#include "firmware_app/chain/correction_set.h"

namespace app {

class ModeIdentification;
class Rebuild;

// Data passed from one object of the chain to the next, where it is more than one core type.

// diagnosis -> displacement, one per report: the geometry to use from a frame on, and when the next report is due. That
// report may change frames later than next_report_at + n_delay_frames.
struct CorrectionSwitch {
  std::uint64_t next_report_at = 0, n_delay_frames = 0;
  Geometry* geometry = nullptr;  // null: nothing changes; owned by the diagnosis, lives to the run's end
  Rebuild* rebuilt = nullptr;    // whose geometry it is; null: it begins without a past
  std::uint64_t from_sequence = 0;
  std::uint32_t correction_set = 0, record = 0;  // numbers in the CorrectionLog
};

// What is known of sums besides their values.
struct SnapshotHead {
  std::uint64_t number = 0;                      // 0, 1, 2, ... in stream time
  std::int64_t t_last_ns = 0;                    // time stamp of the newest sample in the sums
  bool final = false;                            // the record has ended
  std::uint32_t correction_set = 0, record = 0;  // of the newest sample; all samples in the sums share `record`
  core::ReadoutEstimate readout = {};
  core::AircraftLog aircraft = {};        // up to the newest sample
  ModeIdentification* rebuilt = nullptr;  // whose modes belong to these sums; null: those followed so far
};

// spectrum -> modes.
struct SpectrumSnapshot : SnapshotHead {
  SpectrumSnapshot() = default;
  explicit SpectrumSnapshot(core::CpsdSums sized) : sums(std::move(sized)) {}
  core::CpsdSums sums;
};

// modes -> reports and telemetry.
struct IdentificationResult {
  core::ModalEstimate estimate;
  core::CpsdSums sums;
  core::AircraftSummary aircraft = {};  // as received live; empty: nothing was
};

// State of an object of the chain, kept for a later run. Sized once.
struct StateBytes {
  std::vector<std::uint8_t> bytes;
  std::size_t n_used = 0;
};

}  // namespace app
