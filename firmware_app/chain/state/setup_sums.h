#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/spectrum/merge_sums.h"
#include "core/types/modal_estimate.h"
#include "core/types/readout.h"
#include "firmware_app/chain/readout_aware_identifier.h"
#include "firmware_app/chain/state/run_state.h"

namespace app {

// Everything from which a run's last estimate is computed: sums of further runs of the view can be added, and the modes
// identified from all. Independent of the source; plain values that can be sent between processes.
struct SetupSums {
  RunState view;            // must agree; no configuration hash, because it includes the source's name
  core::RecordSums record;  // of all channels, witnesses last; row delays as declared
  ReadoutBasis basis;
  core::ReadoutEstimate from_tracks;
};

[[nodiscard]] std::vector<std::uint8_t> to_bytes(const SetupSums& sums);
// Throws std::runtime_error: the bytes are not spectral sums.
[[nodiscard]] SetupSums setup_sums_of(std::span<const std::uint8_t> bytes);

// The same without the spectra themselves: small, and sufficient for comparison.
[[nodiscard]] SetupSums without_sums(const SetupSums& sums);

// Why the sums of `b` may not be added to those of `a` (another view, another method of summing or identification);
// empty: they may. Both with their sums, or both without.
[[nodiscard]] std::string why_other_view(const SetupSums& a, const SetupSums& b);

// Detects equal samples by their sums: a run record beside its own tracks.csv, or a copy.
struct SumsFingerprint {
  std::uint64_t n_samples = 0;
  std::vector<double> power;  // of every channel, summed over the bins
};
[[nodiscard]] SumsFingerprint fingerprint(const core::CpsdSums& sums);
[[nodiscard]] bool same_samples(const SumsFingerprint& a, const SumsFingerprint& b);

// Runs of one view, added up in the order of add(): the same runs in the same order give the same bits.
class ViewTotal {
 public:
  explicit ViewTotal(std::uint64_t n_segments_of_all);
  // Throws std::invalid_argument where why_other_view() has a reason.
  void add(const SetupSums& sums);
  // Uses the readout time estimated from all runs together. Call after the last add().
  [[nodiscard]] core::ModalEstimate identify() const;

 private:
  core::SumOfRecords sum_;
  SetupSums first_;  // without its sums
  std::vector<core::ReadoutEstimate> from_tracks_;
};

}  // namespace app
