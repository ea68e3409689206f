#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/identification/assignment.h"
#include "core/identification/frequency_trend.h"
#include "core/types/modal_estimate.h"
#include "core/types/state_bytes.h"

namespace core {

struct ModeTrackerConfig {
  std::vector<double> row_delay_s;  // per channel, as removed by the identification; 0 where it removed none
  std::uint32_t n_absent = 3;       // a mode is lost if so many successive estimates do not find it ...
  double keep_lost_s = 1800.0;      // ... but keeps its number if found again within so much record
  double gate_sigmas = 5.0;         // frequencies of one mode differ by less than this in two estimates
  double min_mac = 0.5;             // ... and their shapes have at least this MAC
  double drift_sigmas = 4.0;        // every estimate of every mode is a test: a high limit keeps false alarms rare
  double damping_target = 0.1;      // relative standard deviation to which ModeHistory::more_s refers
};

// Follows modes from one estimate of a growing record to the next and assigns each a number.
//
// Modes are compared as the camera observed them: by apparent frequency, and by shape with its row delays. Both are
// independent of the alias order that the identification chooses, so a mode keeps its number when it changes. Cost of a
// pair, cut at 1:
//     (df / max(5 sigma, zeta f))^2 + (1 - MAC) / 0.5         sigma^2 = sigma_track^2 + sigma_mode^2
// with the stated standard deviations, else with 1.2 sqrt(zeta f / (2 pi T)) (core/planning/hover_time.h). The
// sum of variances is an upper bound for estimates that share data; zeta f is half the half-power bandwidth, within
// which two peaks of one shape are one. Pairs are made by optimal assignment, first of confirmed modes, then of lost
// ones, then of new ones.
//
// A structural mode is new until the next estimate finds it too; then it has a number. Ambiguous poles continue a mode,
// but start none. An estimate whose status is not "ok" has no effect.
//
// With forgetting (ModalEstimate::remembered_s), neither a drift nor more_s is stated: both refer to a growing
// record.
//
// Memory is fixed at construction. Deterministic.
class ModeTracker {
 public:
  static constexpr std::size_t kMaxTracks = 64;
  static constexpr std::size_t kMaxModes = 64;  // of one estimate; structural ones first

  explicit ModeTracker(ModeTrackerConfig config);

  // Sets the row delays from the next estimate on; as many as before.
  void set_row_delays(const std::vector<double>& row_delay_s) noexcept;
  // Discards the followed modes; later ones get new numbers. For estimates from another kind of record.
  void restart() noexcept;
  // Fills `history` of the estimate's modes. Modes with a NaN frequency, damping or shape are excluded.
  void update(ModalEstimate& estimate) noexcept;

  // Saves the state, to resume in another process. restore(): false, and no mode followed, if the bytes are not those
  // of a tracker of as many channels.
  void save(StateWriter& out) const noexcept { describe(out, *this); }
  [[nodiscard]] bool restore(StateReader& in) noexcept;
  [[nodiscard]] std::size_t state_bytes() const noexcept;  // at most

  [[nodiscard]] std::size_t n_followed() const noexcept;  // confirmed, not lost
  // Number of modes beyond capacity: more than kMaxTracks at once, or kMaxModes in one estimate.
  [[nodiscard]] std::uint64_t n_left_out() const noexcept { return n_left_out_; }

 private:
  template <class Archive, class Self>
  static void describe(Archive& archive, Self& self) noexcept {
    archive.value(self.n_samples_);
    archive.value(self.last_id_);
    for (auto& track : self.tracks_) {
      archive.value(track.state);
      archive.value(track.apparent_hz), archive.value(track.frequency_hz), archive.value(track.damping_ratio);
      archive.value(track.variance);
      archive.array(track.seen);
      archive.value(track.last_record_s), archive.value(track.n_absent), archive.value(track.fold_n);
      archive.value(track.history);
      archive.value(track.trend);
    }
  }

  enum class State : std::uint8_t { kFree, kNew, kConfirmed, kLost };
  using Shape = std::vector<std::complex<double>>;

  struct Track {
    State state = State::kFree;
    // From the last estimate that found the mode.
    double apparent_hz = 0.0, frequency_hz = 0.0, damping_ratio = 0.0;
    double variance = 0.0;  // of its frequency, Hz^2
    Shape seen;             // including the row delays
    double last_record_s = 0.0;
    std::uint32_t n_absent = 0;
    int fold_n = 0;
    bool found = false;  // in the current estimate
    ModeHistory history;
    FrequencyTrend trend;
  };
  struct Candidate {
    Mode* mode = nullptr;
    double variance = 0.0;  // of its frequency, Hz^2
    Shape seen;
    bool taken = false;
  };

  void gather(ModalEstimate& estimate) noexcept;
  void add_candidate(Mode& mode, double rate_hz) noexcept;
  [[nodiscard]] double cost(const Track& track, const Candidate& candidate) const noexcept;
  void match(State state) noexcept;
  void follow(Track& track, Candidate& candidate) noexcept;
  void begin(Candidate& candidate, const ModalEstimate& estimate) noexcept;
  void age() noexcept;
  [[nodiscard]] Track* free_track() noexcept;
  void note_frequency(Track& track, const Mode& mode) const noexcept;
  void note_trend(Track& track, const Mode& mode) const noexcept;

  ModeTrackerConfig config_;
  std::array<Track, kMaxTracks> tracks_;
  std::array<Candidate, kMaxModes> candidates_;
  std::size_t n_candidates_ = 0;
  double record_s_ = 0.0, remembered_s_ = 0.0;
  std::uint64_t n_samples_ = 0;
  std::uint32_t last_id_ = 0;
  std::uint64_t n_left_out_ = 0;

  Assignment assignment_{kMaxTracks, kMaxModes};
  std::vector<double> cost_;
  std::array<std::size_t, kMaxTracks> row_track_{};
  std::array<std::size_t, kMaxModes> column_candidate_{};
};

}  // namespace core
