#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/storage/tracks_file.h"
#include "firmware_app/chain/correction_set.h"
#include "firmware_app/config/config.h"
#include "firmware_app/replay/analysis.h"
#include "firmware_app/report/modal_json.h"

namespace app {

// Times of a run's frames, one entry per frame that exists.
struct FrameTimes {
  std::vector<std::uint64_t> number;  // number on the grid; two frames may share one
  std::vector<double> t_s;
  double jitter_rms_s = 0.0;  // of the times about the grid's
  std::size_t n_missing = 0;  // numbers between the first and the last that have no frame
  // A counter would have put the frames on the grid: these times were measured, and show lost, repeated and late
  // frames.
  [[nodiscard]] bool are_measured() const noexcept { return jitter_rms_s > kRounding_s; }
  // The times deviate from an even grid by a relevant amount.
  [[nodiscard]] bool are_uneven(double rate_hz) const noexcept { return jitter_rms_s * rate_hz > kUneven; }
  static constexpr double kRounding_s = 5e-5, kUneven = 0.005;
};

// Displacements of every channel, one value per existing frame, and the frames' times.
struct MeasuredRows {
  ChannelSeries series;
  FrameTimes times;
  std::vector<double> scale_mm_per_px;  // as displacements.csv states it, one per frame; empty: it does not
};
// Measured by the chain from a file of tracks, with `corrections` in force from the first frame on. Throws
// std::invalid_argument: no point in any region, no rate.
[[nodiscard]] MeasuredRows rows_of_tracks(const AppConfig& config, const drivers::TracksFile& file,
                                          const CorrectionSet& corrections = {});
// displacements.csv of a run. Throws drivers::FileError.
[[nodiscard]] MeasuredRows rows_of_displacements(const std::string& path, const std::vector<std::string>& bases);
// Of more than n frames the last ones.
void keep_last(std::size_t n, MeasuredRows& rows);
// The camera of a file of tracks, as the configuration declares it.
[[nodiscard]] core::CameraInfo camera_of_tracks(const drivers::TracksFile& file, const AppConfig& config);

// On a grid of the series' rate: where the times are uneven, interpolated to the grid (no sample across a gap),
// otherwise placed by the frames' numbers.
[[nodiscard]] ChannelSeries on_grid(const MeasuredRows& rows);

// The same for a series whose channels were read from a run's displacements.csv at `path`. False, and the series
// unchanged, where the times were not measured or the file does not come from a run.
bool use_measured_times(const std::string& path, ChannelSeries& series);

// The run's modal.json: the source of its frames' times, the motors of its aircraft. No such file: nothing is stated.
[[nodiscard]] ModalReport report_of(const std::string& folder);

}  // namespace app
