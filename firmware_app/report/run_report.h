#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/types/closure_report.h"
#include "core/types/displacement.h"
#include "core/types/frame.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "core/types/track.h"
#include "drivers/storage/csv_writer.h"
#include "firmware_app/config/config.h"
#include "firmware_app/report/report_folder.h"
#include "firmware_app/report/run_history.h"

namespace app {

// The files of a run: tracks.csv and displacements.csv, written during the run, and modal.json at the end. They are
// written beside the report of an earlier run and replace it as a whole (ReportFolder). Used by one thread. A file
// being written is called *.partial; only a complete one has its name.
class RunReport {
 public:
  // Draws the run's pictures into a folder; throws drivers::FileError.
  using Draw = std::function<void(const std::string& folder)>;

  // Claims the folder and opens the CSV files. Throws drivers::FileError, drivers::FolderInUse.
  RunReport(const std::string& directory, const AppConfig& config, const core::CameraInfo& camera,
            const std::vector<core::ChannelInfo>& channels, const std::vector<std::string>& region_names);

  // One frame, one sample. False: a file failed (disk full); its remainder is lost, counted, and reported by finish().
  bool add(const core::TrackFrame& frame) noexcept;
  bool add(const core::DisplacementSample& sample) noexcept;
  // One estimate, for the pictures of convergence, and what the aircraft has stated up to it.
  void add(const core::ModalEstimate& estimate, const core::AircraftSummary& aircraft) {
    history_.add(estimate);
    history_.set_aircraft(aircraft);
  }

  // corrections: the declared ones; those found during the run are part of the estimate.
  // Writes modal.json, and closure.json from the last report that has a conclusion, draws, completes the CSV files, and
  // puts all in the place of the last report. Throws one drivers::FileError that names every file that failed; the
  // others are complete. Without modal.json the last report stays, as it does where there was no sample.
  void finish(const core::ModalEstimate& last, const core::Health& losses, const std::vector<std::string>& corrections,
              const std::vector<std::string>& caveats = {}, const core::closure::ClosureReport* closure = nullptr,
              const Draw& draw = {});

  // The run went on with the state of one that did not come to its end: modal.json says `recovered`.
  void set_recovered() noexcept { recovered_ = true; }
  // What an earlier run left unfinished in the folder, in words; empty: nothing.
  [[nodiscard]] const std::string& remark() const noexcept { return folder_.remark(); }

  // Data so far, for the pictures.
  [[nodiscard]] const RunHistory& history() const noexcept { return history_; }

  // Frames and samples that arrived after a file had failed.
  [[nodiscard]] std::uint64_t n_items_lost() const noexcept { return n_items_lost_; }
  // Values that were NaN or infinite: empty in the CSV files, null in modal.json. A fault of this program, to be
  // logged.
  [[nodiscard]] std::uint64_t n_not_finite() const noexcept { return n_not_finite_; }

 private:
  void write_track_header(const AppConfig& config, const core::CameraInfo& camera);
  void write_displacement_header(const AppConfig& config, const core::CameraInfo& camera,
                                 const std::vector<core::ChannelInfo>& channels);
  void append_point(fmt::memory_buffer& out, const std::string& prefix, const core::TrackPoint& point);

  ReportFolder folder_;
  std::string method_;
  std::vector<std::string> channel_names_;
  std::vector<std::string> region_names_;
  std::vector<core::Region> regions_;
  RunHistory history_;
  std::optional<drivers::CsvWriter> tracks_;  // empty if the configuration requests no tracks
  std::optional<drivers::CsvWriter> displacements_;
  std::uint64_t n_per_flush_;  // samples between two flushes: what a killed run can lose
  std::uint64_t n_samples_ = 0;
  bool recovered_ = false;
  std::uint64_t n_items_lost_ = 0;
  std::uint64_t n_not_finite_ = 0;
};

}  // namespace app
