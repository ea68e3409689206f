#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/types/readout.h"

namespace core {

// kCandidate: a pole that may be a mode, in a record too short for a verdict.
enum class Verdict : std::uint8_t {
  kStructural,
  kCameraMotion,
  kInputPeak,
  kHarmonic,
  kAmbiguous,
  kNumerical,
  kCandidate
};

[[nodiscard]] const char* to_string(Verdict verdict) noexcept;

// A mode over the estimates of one run (core/identification/mode_tracker.h).
struct ModeHistory {
  std::uint32_t id = 0;                  // 1, 2, ... in the order of confirmation; stays with the mode
  std::uint32_t n_estimates = 0;         // that found it, this one included
  std::uint64_t first_number = 0;        // of the estimate that found it first ...
  double first_seen_s = 0.0;             // ... and its duration_s
  std::uint32_t n_fold_changes = 0;      // how often another true frequency was read from the same peak
  std::optional<double> drift_hz_per_s;  // trend of the true frequency, with its standard deviation: both or none
  std::optional<double> drift_std_hz_per_s;
  bool drifts = false;           // more than estimates that share their data may change
  std::optional<double> more_s;  // record still wanted for a damping good to 10 %; 0 = it is
};

// One pole with its shape. Unknown values are empty, never invented.
struct Mode {
  double frequency_hz = 0.0;  // true frequency (after unfolding, where that was resolved)
  std::optional<double> frequency_std_hz;
  double apparent_hz = 0.0;           // where it stands in the sampled spectrum, 0 .. rate / 2
  std::optional<int> fold_n;          // true signed frequency = apparent + fold_n * rate
  std::optional<double> fold_margin;  // MPC of the best hypothesis minus the second best
  double damping_ratio = 0.0;
  std::optional<double> damping_std;
  std::vector<std::complex<double>> shape;  // per channel; the largest component is 1 (real)
  std::vector<double> shape_std;            // empty = unknown
  double mpc = 0.0;                         // modal phase collinearity, 0..1
  double emac = 0.0;                        // extended modal amplitude coherence, 0..1; times MPC: CMI
  double presence = 0.0;                    // share of model orders in which the pole was found, 0..1
  // Other true frequencies that the samples do not exclude, ascending: those below the limit of ModalEstimate.
  std::vector<double> may_be_hz;
  Verdict verdict = Verdict::kNumerical;
  std::string reason;
  std::optional<ModeHistory> history;  // empty: not followed, or seen in one estimate only
};

// One pole of one model order: a point of the stabilisation diagram.
struct StabilisationPole {
  int order = 0;
  double apparent_hz = 0.0;
  double frequency_hz = 0.0;
  double damping_ratio = 0.0;
  double mpc = 0.0;
  // The cluster that it joined: an index into `modes`, from modes.size() on into `rejected`; -1 = none that is listed.
  int i_line = -1;
};

// Of one estimate; orders beyond it are left out, highest first.
inline constexpr std::size_t kMaxStabilisationPoles = 4096;

// What one channel contributed to an estimate.
struct ChannelRecord {
  double seen = 1.0;             // share of the record in which it has a sample, 0..1
  std::uint64_t n_outlying = 0;  // samples that were masked because their neighbours in time do not allow them
  bool takes_part = true;        // false: its component is unknown in every shape (it is 0 there)
  std::string reason;            // why not; may name a doubt where it takes part
};

// A peak of the spectrum of all channels together: no verdict, but an observation that needs no model.
struct SpectralPeak {
  double frequency_hz = 0.0;   // apparent
  double resolution_hz = 0.0;  // two lines nearer than this are one peak
  double height = 0.0;         // over the spectrum around it, a ratio of powers
  std::vector<double> share;   // per channel: its amplitude there, the largest is 1; 0 where it takes no part
};

// One result of the identification: everything known at `n_samples` of stream time.
struct ModalEstimate {
  std::uint64_t number = 0;     // 0, 1, 2, ... over the run
  std::uint64_t n_samples = 0;  // stream time in samples
  std::uint64_t n_segments = 0;
  std::uint64_t n_missing = 0;
  std::int64_t t_stream_ns = 0;  // time stamp of the last sample used
  double rate_hz = 0.0;
  double duration_s = 0.0;
  double remembered_s = 0.0;  // of it; less only where old samples are forgotten
  // Degrees of freedom of the standard deviations (Student's t); 0 = none are stated.
  double degrees_of_freedom = 0.0;
  int model_order = 0;                    // order at which the canonical correlations fall off; 0 = unclear
  bool final = false;                     // the last of a run
  std::string status;                     // "ok", or why there are no modes
  std::vector<std::string> amendments;    // effects found and corrected by the run, beyond the declared ones
  std::optional<ReadoutFinding> readout;  // basis of the row delays; empty: not estimated
  // Two lines nearer than this cannot be distinguished: one over the longest stretch that is analysed; 0 = unknown.
  double resolution_hz = 0.0;
  std::vector<ChannelRecord> channels;    // as the components of the shapes; empty = all take part
  std::vector<SpectralPeak> peaks;        // by frequency
  std::vector<Mode> modes;                // structural, by frequency
  std::vector<Mode> rejected;             // every other pole, with its reason
  std::vector<StabilisationPole> poles;   // of all orders, ascending; at most kMaxStabilisationPoles
};

}  // namespace core
