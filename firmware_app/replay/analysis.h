#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/identification/frequency_response.h"
#include "core/identification/identifier.h"
#include "core/types/displacement.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "firmware_app/chain/state/setup_sums.h"
#include "firmware_app/config/config.h"

namespace app {

// The service's chain in one thread, starting from a later stage, for the desktop tools.

// Samples of all channels on a uniform grid. NaN = missing.
struct ChannelSeries {
  double rate_hz = 0.0;
  std::vector<core::ChannelInfo> channels;
  std::vector<std::vector<double>> value;  // per channel, equally long
  std::string unit = "units";              // of the values, as shown to readers
};

// Words for the head of a page, and a result to compare with: as report.title, report.notes and report.compare.
struct PageHead {
  std::string title;
  std::vector<std::string> notes;
  std::string compare;
};

struct SeriesOptions {
  SpectrumConfig spectrum{.segment = 0};  // segment 0 = chosen from the record's length, at the decimated rate
  core::IdentifierConfig identifier;      // references are indices into ChannelSeries::channels
  // Slower rate: the record is decimated as far as identifier.max_frequency_hz stays in the filter's passband; 0: where
  // the motion needs a quarter of the rate or less (oversampling.h).
  bool decimate = true;
  bool mask_faults = true;                          // series_faults.h; false: every number counts
  std::string report_directory;                     // must exist; empty = no report
  std::string source;                               // input named in the report
  std::function<void(double share)> progress = {};  // called at intervals with the share done, 0..1
  PageHead head = {};
};

struct SeriesResult {
  core::ModalEstimate estimate;
  std::vector<core::ChannelInfo> channels;   // those of the shapes, without excluded ones
  std::vector<core::ResponsePeak> response;  // to the first base channel; empty without one
  int decimation = 1;
  int segment = 0;                   // samples of the decimated record
  std::vector<std::string> remarks;  // choices, exclusions and doubts, for the reader
};

// Spectra and modes of a record, computed as by the service at the end of a run; writes pictures and report.html into
// the report's folder. A channel without samples, without motion, or equal to another is excluded, with a remark.
// Throws std::invalid_argument when no channel is left, or the record is shorter than one segment.
[[nodiscard]] SeriesResult identify_series(const ChannelSeries& series, const SeriesOptions& options);

// Recorded tracks -> geometry -> spectra -> modes; writes the service's report to `report_directory` if not empty.
struct TracksResult {
  core::ModalEstimate estimate;
  core::Health losses;
  std::vector<core::ChannelInfo> channels;
  std::string method;                // "paper" | "hovermodal"
  int n_differences = 0;             // the prewhitening used
  SetupSums sums;                    // from which the estimate was computed; those of further runs can be added
  std::vector<std::string> changes;  // with closure.adopt: auto, corrections started or withdrawn, for a reader
};
// `progress`: called after every frame with their number so far and that of the file.
using FrameProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;
[[nodiscard]] TracksResult replay_tracks(const AppConfig& config, const std::string& tracks_path,
                                         const std::string& report_directory, const FrameProgress& progress = {});

// The same from run records (record.directory): to the same bits as the run's own estimates. Several runs of one view
// continue each other's sums, and give one estimate; its report then has no time series.
struct RecordOverrides {
  std::string config_path;             // instead of the recorded configuration; empty = that one
  std::vector<std::string> overrides;  // "section.key=value"
  // closure.adopt: report taken as off: such reports change nothing else, and take seconds each.
  bool skips_closure_reports = false;
};
struct RecordsResult {
  TracksResult tracks;
  std::vector<std::string> remarks;  // what a record lacks, for a reader
};
// `progress`: called after every frame with the bytes read so far and those of the records.
using ByteProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;
// Throws ConfigError, drivers::FileError, std::invalid_argument where runs do not fit together.
[[nodiscard]] RecordsResult replay_records(const std::vector<std::string>& paths, const RecordOverrides& overrides,
                                           const std::string& report_directory, const ByteProgress& progress = {});

}  // namespace app
