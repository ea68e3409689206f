#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/rotors/aircraft.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"
#include "core/types/track.h"
#include "firmware_app/report/plot/binned_series.h"

namespace app {

// Time history of a run for the pictures: displacement of every channel, scale, track quality of every region,
// every mode over the estimates. Memory is fixed at construction, whatever the length of the run. Used by one
// thread.
class RunHistory {
 public:
  struct Region {
    BinnedSeries share_seen;  // of the region's points, 0..1
    BinnedSeries sigma_px;    // rms over the points seen in a frame
    std::size_t n_points = 0;
  };

  // A mode that the tracker follows, over the record behind each estimate (cells = samples).
  struct FollowedMode {
    std::uint32_t id = 0;  // 0 = unused
    BinnedSeries frequency_hz;
    BinnedSeries damping_ratio;
  };
  static constexpr std::size_t kMaxFollowed = 16;  // later ones are not kept

  RunHistory(double rate_hz, std::size_t n_channels, std::size_t n_regions);

  void add(const core::TrackFrame& frame) noexcept;
  void add(const core::DisplacementSample& sample) noexcept;
  void add(const core::ModalEstimate& estimate) noexcept;
  void set_aircraft(const core::AircraftSummary& aircraft) { aircraft_ = aircraft; }
  // A row of a time series: NaN = missing.
  void add(std::uint64_t i_cell, std::span<const double> values) noexcept;

  [[nodiscard]] double cell_s() const noexcept { return 1.0 / rate_hz_; }
  [[nodiscard]] double duration_s() const noexcept { return static_cast<double>(n_cells_) / rate_hz_; }
  [[nodiscard]] std::uint64_t n_samples() const noexcept { return n_samples_; }
  [[nodiscard]] const std::vector<BinnedSeries>& displacements() const noexcept { return displacements_; }
  [[nodiscard]] const BinnedSeries& scale() const noexcept { return scale_; }
  [[nodiscard]] const std::vector<Region>& regions() const noexcept { return regions_; }
  // nullptr: not kept.
  [[nodiscard]] const FollowedMode* followed(std::uint32_t id) const noexcept;
  [[nodiscard]] std::uint64_t n_estimates() const noexcept { return n_estimates_; }
  [[nodiscard]] const core::AircraftSummary& aircraft() const noexcept { return aircraft_; }  // so far
  [[nodiscard]] bool has_tracks() const noexcept { return has_tracks_; }

 private:
  // Empty: before the first frame.
  [[nodiscard]] std::optional<std::uint64_t> cell_of(std::int64_t t_ns) noexcept;

  double rate_hz_;
  std::optional<std::int64_t> first_ns_;
  std::uint64_t n_cells_ = 0, n_samples_ = 0, n_estimates_ = 0;
  bool has_tracks_ = false;
  core::AircraftSummary aircraft_;
  std::vector<BinnedSeries> displacements_;
  BinnedSeries scale_;
  std::vector<Region> regions_;
  std::vector<FollowedMode> followed_;
  struct Count {
    std::size_t n_points = 0, n_seen = 0;
    double sum_variance = 0.0;
  };
  std::vector<Count> counts_;  // of the current frame, per region
};

}  // namespace app
