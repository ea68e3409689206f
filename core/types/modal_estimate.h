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
  std::uint32_t n_estimates = 0;         // estimates that found it, including this one
  std::uint64_t first_number = 0;        // of the estimate that found it first ...
  double first_seen_s = 0.0;             // ... and its duration_s
  std::uint32_t n_fold_changes = 0;      // number of changes of the alias order of the same peak
  std::optional<double> drift_hz_per_s;  // trend of the true frequency, with its standard deviation: both or none
  std::optional<double> drift_std_hz_per_s;
  bool drifts = false;           // the trend exceeds what estimates with shared data may show
  std::optional<double> more_s;  // further record needed for a damping good to 10 %; 0 = reached
};

// One pole with its shape. Unknown values are empty.
struct Mode {
  double frequency_hz = 0.0;  // true frequency (after unfolding, if the alias order was determined)
  std::optional<double> frequency_std_hz;
  double apparent_hz = 0.0;           // frequency in the sampled spectrum, 0 .. rate / 2
  std::optional<int> fold_n;          // true signed frequency = apparent + fold_n * rate
  std::optional<double> fold_margin;  // MPC of the best hypothesis minus that of the second best
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
  // Cluster of the pole: an index into `modes`, from modes.size() on into `rejected`; -1 = none that is listed.
  int i_line = -1;
};

// Limit of one estimate; the highest orders beyond it are omitted.
inline constexpr std::size_t kMaxStabilisationPoles = 4096;

// What one channel contributed to an estimate.
struct ChannelRecord {
  double seen = 1.0;             // share of the record in which it has a sample, 0..1
  std::uint64_t n_outlying = 0;  // samples masked because they are inconsistent with their neighbours in time
  bool takes_part = true;        // false: its component is unknown in every shape (and is 0)
  std::string reason;            // reason why not; for a channel that takes part, possibly a doubt
};

// A peak of the summed spectrum of all channels: an observation without model and verdict.
struct SpectralPeak {
  double frequency_hz = 0.0;   // apparent
  double resolution_hz = 0.0;  // lines closer than this appear as one peak
  double height = 0.0;         // ratio of its power to that of the spectrum around it
  std::vector<double> share;   // amplitude per channel, the largest is 1; 0 for channels that do not take part
};

// One result of the identification: all that is known at `n_samples` of stream time.
struct ModalEstimate {
  std::uint64_t number = 0;     // 0, 1, 2, ... over the run
  std::uint64_t n_samples = 0;  // stream time in samples
  std::uint64_t n_segments = 0;
  std::uint64_t n_missing = 0;
  std::int64_t t_stream_ns = 0;  // time stamp of the last sample used
  double rate_hz = 0.0;
  double duration_s = 0.0;
  double remembered_s = 0.0;  // part of duration_s that is remembered; less only with forgetting
  // Degrees of freedom of the standard deviations (Student's t); 0 = none are stated.
  double degrees_of_freedom = 0.0;
  int model_order = 0;                    // order at which the canonical correlations drop; 0 = unclear
  bool final = false;                     // the last of a run
  std::string status;                     // "ok", or the reason why there are no modes
  std::vector<std::string> amendments;    // effects found and corrected by the run, in addition to the declared ones
  std::optional<ReadoutFinding> readout;  // basis of the row delays; empty: not estimated
  // Two lines closer than this cannot be distinguished: one over the longest stretch that is analysed; 0 = unknown.
  double resolution_hz = 0.0;
  std::vector<ChannelRecord> channels;   // in the order of the shapes' components; empty = all take part
  std::vector<SpectralPeak> peaks;       // by frequency
  std::vector<Mode> modes;               // structural, by frequency
  std::vector<Mode> rejected;            // every other pole, with its reason
  std::vector<StabilisationPole> poles;  // of all orders, ascending; at most kMaxStabilisationPoles
};

}  // namespace core
