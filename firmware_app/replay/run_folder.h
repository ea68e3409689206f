#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types/recording_times.h"
#include "drivers/storage/csv.h"
#include "firmware_app/chain/correction_set.h"
#include "firmware_app/config/config.h"
#include "firmware_app/replay/analysis.h"

namespace app {

// Frames of a run in time, one entry per frame that is there.
struct FrameTimes {
  std::vector<std::uint64_t> number;  // of the grid; two frames may share one
  std::vector<double> t_s;
  double jitter_rms_s = 0.0;  // of the times about the grid's
  std::size_t n_missing = 0;  // numbers between the first and the last that are not there
  // A counter would have put them on the grid: these were measured, and tell what is lost, repeated and late.
  [[nodiscard]] bool are_measured() const noexcept { return jitter_rms_s > kRounding_s; }
  // They lie so far off an even grid that it matters.
  [[nodiscard]] bool are_uneven(double rate_hz) const noexcept { return jitter_rms_s * rate_hz > kUneven; }
  static constexpr double kRounding_s = 5e-5, kUneven = 0.005;
};

// Displacements of every channel, one value per frame that is there, and when these were taken.
struct MeasuredRows {
  ChannelSeries series;
  FrameTimes times;
};
// As the chain measures them from a file of tracks, with `corrections` in force from the first frame on. Throws
// std::invalid_argument: no point in any region, no rate.
[[nodiscard]] MeasuredRows rows_of_tracks(const AppConfig& config, const drivers::TracksFile& file,
                                          const CorrectionSet& corrections = {});
// displacements.csv of a run. Throws drivers::FileError.
[[nodiscard]] MeasuredRows rows_of_displacements(const std::string& path, const std::vector<std::string>& bases);
// The camera of a file of tracks, as the configuration declares it.
[[nodiscard]] core::CameraInfo camera_of_tracks(const drivers::TracksFile& file, const AppConfig& config);

// On a grid of the series' rate: where the times are uneven, interpolated to its instants (no sample across a gap),
// else by the frames' numbers.
[[nodiscard]] ChannelSeries on_grid(const MeasuredRows& rows);

// The same for a series whose channels were read from a run's displacements.csv at `path`. False, and the series as it
// is, where the times were not measured or the file is none of a run.
bool use_measured_times(const std::string& path, ChannelSeries& series);

// Where the frames' times come from, by the run's modal.json; empty: it does not say, or is not there.
[[nodiscard]] core::RecordingTimes recording_of(const std::string& folder);

}  // namespace app
