#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/spectrum/merge_sums.h"
#include "core/types/modal_estimate.h"
#include "core/types/readout.h"
#include "firmware_app/readout_use.h"
#include "firmware_app/run_state.h"

namespace app {

// What a run's last estimate is made of, whole: the sums of further runs of the view can be added, and the modes of all
// identified. Nothing of where it came from; plain values, to be carried from one process to another.
struct ViewSums {
  RunState view;            // what must agree; no configuration hash, which holds the source's name
  core::RecordSums record;  // of all channels, witnesses last; row delays as declared
  ReadoutBasis basis;
  core::ReadoutEstimate from_tracks;
};

[[nodiscard]] std::vector<std::uint8_t> to_bytes(const ViewSums& sums);
// Throws std::runtime_error: bytes that are no sums.
[[nodiscard]] ViewSums view_sums_of(std::span<const std::uint8_t> bytes);

// The same but for the spectra themselves: small, and enough to be compared.
[[nodiscard]] ViewSums without_sums(const ViewSums& sums);

// Why the sums of `b` may not be added to those of `a`, empty when they may: another view, another way of summing or of
// identifying. Both with their sums, or both without.
[[nodiscard]] std::string why_other_view(const ViewSums& a, const ViewSums& b);

// The same samples, as far as sums tell: a record beside its own tracks.csv, or a copy.
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
  void add(const ViewSums& sums);
  // With the readout time as all runs together know it. After the last.
  [[nodiscard]] core::ModalEstimate identify() const;

 private:
  core::SumOfRecords sum_;
  ViewSums first_;  // without its sums
  std::vector<core::ReadoutEstimate> from_tracks_;
};

}  // namespace app
