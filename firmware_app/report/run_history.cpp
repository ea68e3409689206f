#include "firmware_app/report/run_history.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {

RunHistory::RunHistory(double rate_hz, std::size_t n_channels, std::size_t n_regions)
    : rate_hz_(rate_hz > 0.0 ? rate_hz : 1.0),
      displacements_(n_channels),
      regions_(n_regions),
      followed_(kMaxFollowed),
      counts_(n_regions) {}

std::optional<std::uint64_t> RunHistory::cell_of(std::int64_t t_ns) noexcept {
  if (!first_ns_) first_ns_ = t_ns;
  if (t_ns < *first_ns_) return std::nullopt;
  const double cells =
      static_cast<double>(static_cast<std::uint64_t>(t_ns) - static_cast<std::uint64_t>(*first_ns_)) * 1e-9 * rate_hz_;
  const auto i_cell = static_cast<std::uint64_t>(std::llround(cells));
  n_cells_ = std::max(n_cells_, i_cell + 1);
  return i_cell;
}

void RunHistory::add(const core::TrackFrame& frame) noexcept {
  const auto i_cell = cell_of(frame.t_start_ns);
  if (!i_cell) return;
  std::fill(counts_.begin(), counts_.end(), Count{});
  for (const core::TrackPoint& point : frame.points) {
    if (point.region >= counts_.size()) continue;
    Count& count = counts_[point.region];
    ++count.n_points;
    if (!point.seen) continue;
    ++count.n_seen;
    count.sum_variance += point.sigma_px * point.sigma_px;
  }
  has_tracks_ = true;
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    const Count& count = counts_[r];
    regions_[r].n_points = std::max(regions_[r].n_points, count.n_points);
    if (count.n_points == 0) continue;
    const auto n_seen = static_cast<double>(count.n_seen);
    regions_[r].share_seen.add(*i_cell, n_seen / static_cast<double>(count.n_points));
    if (count.n_seen > 0) regions_[r].sigma_px.add(*i_cell, std::sqrt(count.sum_variance / n_seen));
  }
}

void RunHistory::add(const core::DisplacementSample& sample) noexcept {
  const auto i_cell = cell_of(sample.t_start_ns);
  if (!i_cell) return;
  ++n_samples_;
  if (sample.scale_mm_per_px > 0.0) scale_.add(*i_cell, sample.scale_mm_per_px);
  for (std::size_t c = 0; c < displacements_.size(); ++c) {
    if (c < sample.seen.size() && c < sample.value_mm.size() && sample.seen[c] != 0)
      displacements_[c].add(*i_cell, sample.value_mm[c]);
  }
}

void RunHistory::add(const core::ModalEstimate& estimate) noexcept {
  ++n_estimates_;
  for (const core::Mode& mode : estimate.modes) {
    if (!mode.history) continue;
    const auto place = std::find_if(followed_.begin(), followed_.end(), [&](const FollowedMode& followed) {
      return followed.id == mode.history->id || followed.id == 0;
    });
    if (place == followed_.end()) continue;
    place->id = mode.history->id;
    place->frequency_hz.add(estimate.n_samples, mode.frequency_hz);
    place->damping_ratio.add(estimate.n_samples, mode.damping_ratio);
  }
}

const RunHistory::FollowedMode* RunHistory::followed(std::uint32_t id) const noexcept {
  const auto place = std::find_if(followed_.begin(), followed_.end(),
                                  [&](const FollowedMode& followed) { return followed.id == id && id != 0; });
  return place == followed_.end() ? nullptr : &*place;
}

void RunHistory::add(std::uint64_t i_cell, std::span<const double> values) noexcept {
  n_cells_ = std::max(n_cells_, i_cell + 1);
  ++n_samples_;
  for (std::size_t c = 0; c < displacements_.size() && c < values.size(); ++c) displacements_[c].add(i_cell, values[c]);
}

}  // namespace app
