#include "core/identification/mode_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/identification/mac.h"
#include "core/planning/hover_time.h"

namespace core {

namespace {

using Complex = std::complex<double>;

// Damping estimates may scatter to 0 and below; no structure has so little damping.
double sane_damping(double damping_ratio) noexcept { return std::clamp(damping_ratio, 1e-3, 0.2); }

// c^2 of FrequencyTrend: variance of the frequency times the record's length.
double variance_time(const Mode& mode, double record_s) noexcept {
  const double sigma_hz =
      mode.frequency_hz * planning::relative_frequency_sigma(mode.frequency_hz, sane_damping(mode.damping_ratio), 1.0);
  const double stated_hz = mode.frequency_std_hz.value_or(0.0);
  return std::isfinite(stated_hz) && stated_hz > 0.0 ? stated_hz * stated_hz * record_s : sigma_hz * sigma_hz;
}

bool is_usable(const Mode& mode, std::size_t n_channels) noexcept {
  const bool finite = std::isfinite(mode.frequency_hz) && std::isfinite(mode.apparent_hz) &&
                      std::isfinite(mode.damping_ratio) && mode.frequency_hz > 0.0;
  return finite && mode.shape.size() == n_channels && std::all_of(mode.shape.begin(), mode.shape.end(), [](Complex z) {
           return std::isfinite(z.real()) && std::isfinite(z.imag());
         });
}

bool is_structural(const Mode& mode) noexcept { return mode.verdict == Verdict::kStructural; }

// Applies the row delays to a shape, as the camera sees it: the inverse of core/identification/folding.cpp.
void put_delays_back(const Mode& mode, double rate_hz, const std::vector<double>& delay_s,
                     std::vector<Complex>& seen) noexcept {
  const double w = 2.0 * std::numbers::pi * mode.frequency_hz;
  const double zeta = std::clamp(mode.damping_ratio, -1.0, 1.0);
  const Complex s(-zeta * w, w * std::sqrt(1.0 - zeta * zeta));
  const bool mirrored = mode.apparent_hz + mode.fold_n.value_or(0) * rate_hz < 0.0;
  for (std::size_t c = 0; c < seen.size(); ++c) {
    const Complex z = mode.shape[c] * std::exp(s * delay_s[c]);
    seen[c] = mirrored ? std::conj(z) : z;
  }
}

constexpr double kAll = 0.99;  // share of remembered samples above which a record counts as without forgetting

// Missing samples do not count as observed time.
double observed_s(const ModalEstimate& estimate, std::size_t n_channels) noexcept {
  const double cells = static_cast<double>(estimate.n_samples) * static_cast<double>(n_channels);
  const double missing = cells > 0.0 ? std::min(1.0, static_cast<double>(estimate.n_missing) / cells) : 0.0;
  return std::isfinite(estimate.duration_s) ? std::max(0.0, estimate.duration_s * (1.0 - missing)) : 0.0;
}

bool is_finite(const std::vector<std::complex<double>>& shape) noexcept {
  return std::all_of(shape.begin(), shape.end(),
                     [](const auto& x) { return std::isfinite(x.real()) && std::isfinite(x.imag()); });
}

}  // namespace

ModeTracker::ModeTracker(ModeTrackerConfig config) : config_(std::move(config)), cost_(kMaxTracks * kMaxModes) {
  for (Track& track : tracks_) track.seen.resize(config_.row_delay_s.size());
  for (Candidate& candidate : candidates_) candidate.seen.resize(config_.row_delay_s.size());
}

std::size_t ModeTracker::n_followed() const noexcept {
  return static_cast<std::size_t>(std::count_if(tracks_.begin(), tracks_.end(),
                                                [](const Track& track) { return track.state == State::kConfirmed; }));
}

void ModeTracker::set_row_delays(const std::vector<double>& row_delay_s) noexcept {
  std::copy_n(row_delay_s.begin(), std::min(row_delay_s.size(), config_.row_delay_s.size()),
              config_.row_delay_s.begin());
}

bool ModeTracker::restore(StateReader& in) noexcept {
  describe(in, *this);
  bool sane = in.ok();
  for (Track& track : tracks_) {
    sane = sane && track.state <= State::kLost && track.variance >= 0.0 && std::isfinite(track.variance) &&
           std::isfinite(track.apparent_hz) && std::isfinite(track.frequency_hz) &&
           std::isfinite(track.damping_ratio) && std::isfinite(track.last_record_s) && is_finite(track.seen);
    track.found = false;
    // All other fields are recomputed before they are reported; flags read from a file may be any byte.
    ModeHistory kept;
    kept.id = track.history.id, kept.n_estimates = track.history.n_estimates;
    kept.first_number = track.history.first_number, kept.first_seen_s = track.history.first_seen_s;
    kept.n_fold_changes = track.history.n_fold_changes;
    track.history = kept;
  }
  if (!sane) restart(), last_id_ = 0;
  return sane;
}

std::size_t ModeTracker::state_bytes() const noexcept {
  return 64 + kMaxTracks * (sizeof(Track) + 16 + config_.row_delay_s.size() * sizeof(Complex));
}

void ModeTracker::restart() noexcept {
  for (Track& track : tracks_) track.state = State::kFree;
  n_samples_ = 0;
}

void ModeTracker::update(ModalEstimate& estimate) noexcept {
  for (auto* list : {&estimate.modes, &estimate.rejected}) {
    for (Mode& mode : *list) mode.history.reset();
  }
  if (estimate.status != "ok") return;
  const double record_s = observed_s(estimate, config_.row_delay_s.size());
  if (!(record_s > 0.0)) return;
  if (estimate.n_samples < n_samples_) {  // another record: estimates no longer share data
    for (Track& track : tracks_) track.trend.restart(), track.last_record_s = record_s;
  }
  n_samples_ = estimate.n_samples;
  record_s_ = record_s;
  const double share = estimate.duration_s > 0.0 ? estimate.remembered_s / estimate.duration_s : 1.0;
  remembered_s_ = share > 0.0 && share < kAll ? share * record_s : record_s;  // 0: not stated
  gather(estimate);
  for (const State state : {State::kConfirmed, State::kLost, State::kNew}) match(state);
  age();
  for (std::size_t i = 0; i < n_candidates_; ++i) {
    if (!candidates_[i].taken && is_structural(*candidates_[i].mode)) begin(candidates_[i], estimate);
  }
}

void ModeTracker::gather(ModalEstimate& estimate) noexcept {
  n_candidates_ = 0;
  for (Mode& mode : estimate.modes) add_candidate(mode, estimate.rate_hz);
  for (Mode& mode : estimate.rejected) {
    if (mode.verdict == Verdict::kAmbiguous) add_candidate(mode, estimate.rate_hz);
  }
}

void ModeTracker::add_candidate(Mode& mode, double rate_hz) noexcept {
  if (!is_usable(mode, config_.row_delay_s.size())) return;
  if (n_candidates_ == kMaxModes) {
    ++n_left_out_;
    return;
  }
  Candidate& candidate = candidates_[n_candidates_++];
  candidate.mode = &mode;
  candidate.variance = variance_time(mode, remembered_s_) / remembered_s_;
  candidate.taken = false;
  put_delays_back(mode, rate_hz, config_.row_delay_s, candidate.seen);
}

double ModeTracker::cost(const Track& track, const Candidate& candidate) const noexcept {
  const Mode& mode = *candidate.mode;
  const double sigma_hz = std::sqrt(track.variance + candidate.variance);
  const double half_band_hz =
      sane_damping(std::min(track.damping_ratio, mode.damping_ratio)) * std::min(track.frequency_hz, mode.frequency_hz);
  const double gate_hz = std::max(config_.gate_sigmas * sigma_hz, half_band_hz);
  const double apart = (mode.apparent_hz - track.apparent_hz) / gate_hz;
  return apart * apart + (1.0 - mac(track.seen, candidate.seen)) / (1.0 - config_.min_mac);
}

void ModeTracker::match(State state) noexcept {
  std::size_t n_rows = 0, n_columns = 0;
  for (std::size_t i = 0; i < kMaxTracks; ++i) {
    if (tracks_[i].state == state && !tracks_[i].found) row_track_[n_rows++] = i;
  }
  for (std::size_t i = 0; i < n_candidates_; ++i) {
    const bool fits = state != State::kNew || is_structural(*candidates_[i].mode);
    if (fits && !candidates_[i].taken) column_candidate_[n_columns++] = i;
  }
  for (std::size_t r = 0; r < n_rows; ++r) {
    for (std::size_t c = 0; c < n_columns; ++c) {
      cost_[r * n_columns + c] = cost(tracks_[row_track_[r]], candidates_[column_candidate_[c]]);
    }
  }
  const auto column_of = assignment_.solve(cost_, n_rows, n_columns);
  // In the order of the modes, so that modes confirmed together are numbered by ascending frequency.
  for (std::size_t c = 0; c < n_columns; ++c) {
    const auto row = std::find(column_of.begin(), column_of.end(), c);
    if (row == column_of.end()) continue;
    follow(tracks_[row_track_[static_cast<std::size_t>(row - column_of.begin())]], candidates_[column_candidate_[c]]);
  }
}

void ModeTracker::follow(Track& track, Candidate& candidate) noexcept {
  Mode& mode = *candidate.mode;
  candidate.taken = true;
  track.found = true;
  track.n_absent = 0;
  track.apparent_hz = mode.apparent_hz;
  track.damping_ratio = mode.damping_ratio;
  track.variance = candidate.variance;
  track.last_record_s = record_s_;
  std::swap(track.seen, candidate.seen);
  if (track.state == State::kNew) track.history.id = ++last_id_;
  track.state = State::kConfirmed;
  ++track.history.n_estimates;
  note_frequency(track, mode);
  note_trend(track, mode);
  mode.history = track.history;
}

// While the alias order is undetermined, a changed order is not a finding.
void ModeTracker::note_frequency(Track& track, const Mode& mode) const noexcept {
  const int fold_n = mode.fold_n.value_or(0);
  if (fold_n != track.fold_n) {
    if (!is_structural(mode)) return;
    ++track.history.n_fold_changes;
    track.fold_n = fold_n;
    track.trend.restart();
  }
  track.frequency_hz = mode.frequency_hz;
  track.trend.add(mode.frequency_hz, record_s_);
}

void ModeTracker::note_trend(Track& track, const Mode& mode) const noexcept {
  constexpr std::size_t kLeastPieces = 4;  // three would leave one degree of freedom for the residuals
  ModeHistory& out = track.history;
  out.drift_hz_per_s.reset();
  out.drift_std_hz_per_s.reset();
  out.drifts = false;
  out.more_s.reset();
  if (remembered_s_ < record_s_) return;  // both assume a record that grows
  if (const auto slope = track.trend.slope(variance_time(mode, record_s_))) {
    out.drift_hz_per_s = slope->hz_per_s;
    out.drift_std_hz_per_s = slope->std_hz_per_s;
    out.drifts = track.trend.n_pieces() >= kLeastPieces &&
                 std::abs(slope->hz_per_s) > config_.drift_sigmas * slope->std_hz_per_s;
  }
  const double zeta = sane_damping(mode.damping_ratio);
  const double stated = mode.damping_std.value_or(0.0);
  const double wanted_s = std::isfinite(stated) && stated > 0.0
                              ? record_s_ * std::pow(stated / (zeta * config_.damping_target), 2)
                              : planning::seconds_for_damping(mode.frequency_hz, zeta, config_.damping_target);
  out.more_s = std::max(0.0, wanted_s - record_s_);
}

void ModeTracker::age() noexcept {
  for (Track& track : tracks_) {
    if (std::exchange(track.found, false)) continue;
    if (track.state == State::kNew) track.state = State::kFree;
    if (track.state == State::kConfirmed && ++track.n_absent >= config_.n_absent) track.state = State::kLost;
    if (track.state == State::kLost && record_s_ - track.last_record_s > config_.keep_lost_s) {
      track.state = State::kFree;
    }
  }
}

// If no track is free, the mode that has been lost longest is replaced.
ModeTracker::Track* ModeTracker::free_track() noexcept {
  Track* oldest = nullptr;
  for (Track& track : tracks_) {
    if (track.state == State::kFree) return &track;
    if (track.state != State::kLost) continue;
    if (oldest == nullptr || track.last_record_s < oldest->last_record_s) oldest = &track;
  }
  return oldest;
}

void ModeTracker::begin(Candidate& candidate, const ModalEstimate& estimate) noexcept {
  Track* track = free_track();
  if (track == nullptr) {
    ++n_left_out_;
    return;
  }
  const Mode& mode = *candidate.mode;
  track->state = State::kNew;
  track->apparent_hz = mode.apparent_hz;
  track->damping_ratio = mode.damping_ratio;
  track->variance = candidate.variance;
  track->last_record_s = record_s_;
  track->n_absent = 0;
  track->fold_n = mode.fold_n.value_or(0);
  track->history = ModeHistory{};
  track->history.n_estimates = 1;
  track->history.first_number = estimate.number;
  track->history.first_seen_s = estimate.duration_s;
  track->trend.restart();
  std::swap(track->seen, candidate.seen);
  note_frequency(*track, mode);
}

}  // namespace core
