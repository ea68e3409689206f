#include "firmware_app/replay/level_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/observation/observation_level.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/chain/observation.h"
#include "firmware_app/chain/reference_modes.h"
#include "firmware_app/chain/structure_comparison.h"
#include "firmware_app/replay/loop_corrections.h"
#include "firmware_app/replay/loop_modes.h"
#include "firmware_app/replay/response_analysis.h"
#include "firmware_app/replay/run_folder.h"
#include "firmware_app/replay/tracks_record.h"
#include "firmware_app/report/structure_level_pictures.h"

namespace app {
namespace {

using core::closure::ClosureResult;
using core::closure::ClosureStep;
using core::closure::LoopLevel;
using core::closure::LoopResult;

std::string numbers_of(const ClosureStep& step) {
  return step.parameters.empty() ? step.effect : step.effect + ": " + parameters_text(step);
}

// Converts a result of the common loop; its correction is added later.
LoopLevel level_of(const std::string& name, ClosureResult result) {
  LoopLevel out;
  out.level = name, out.unit = result.unit;
  out.residual_before = result.baseline_rms, out.residual_after = result.residual_rms;
  out.left = result.unexplained;
  for (const ClosureStep& step : result.steps) {
    std::string words = numbers_of(step);
    for (const std::string& rival : step.rivals) words += (&rival == &step.rivals.front() ? "; or " : ", ") + rival;
    out.findings.push_back({std::move(words), {}});
  }
  out.result = std::move(result);
  return out;
}

LoopLevel skipped(const std::string& name, const std::string& why) {
  LoopLevel out;
  out.level = name, out.skipped = why;
  return out;
}

// Frames that a level goes through.
std::size_t frames_in(std::size_t most_cells, std::size_t n_columns) {
  return std::max<std::size_t>(1, most_cells / std::max<std::size_t>(1, n_columns));
}

std::string last_part(std::size_t n_frames, std::size_t n_all, double rate_hz) {
  if (n_frames >= n_all) return {};
  return fmt::format("; the last {:.0f} s of {:.0f} s were gone through, for the sake of memory",
                     static_cast<double>(n_frames) / rate_hz, static_cast<double>(n_all) / rate_hz);
}

// The record of a run as it passes through the levels.
class LevelLoop {
 public:
  explicit LevelLoop(const LevelLoopInputs& inputs) : inputs_(inputs) {
    const std::filesystem::path folder = inputs.folder;
    tracks_path_ = (folder / "tracks.csv").string(), series_path_ = (folder / "displacements.csv").string();
    if (inputs.config && std::filesystem::exists(tracks_path_)) {
      tracks_ = drivers::read_tracks_csv(tracks_path_);
      rows_ = rows_of_tracks(*inputs.config, *tracks_);
    } else {
      rows_ = rows_of_displacements(series_path_, inputs.bases);
    }
    if (rows_.times.number.empty()) throw drivers::FileError(inputs.folder + ": the record has no frame");
    n_frames_ = rows_.times.number.size();
    keep_end();
    const ModalReport report = report_of(inputs.folder);
    times_ = report.losses.times;
    motors_ = core::MotorLines(report.aircraft.motors);
    as_measured_ = by_numbers(rows_);
    series_ = on_grid(rows_);
  }

  LoopResult run() {
    LoopResult out;
    out.levels.push_back(clock());
    out.levels.push_back(observation());
    out.levels.push_back(response());
    tell("identifying the modes before and after");
    const LoopModes modes(inputs_.reference_hz, inputs_.max_frequency_hz);
    out.levels.push_back(structure(modes.compare(as_measured_, series_, out)));
    return out;
  }

 private:
  // The record before any correction, frames placed by their numbers.
  static ChannelSeries by_numbers(MeasuredRows rows) {
    rows.times.jitter_rms_s = 0.0;
    return on_grid(rows);
  }

  void keep_end() { keep_last(frames_in(inputs_.most_cells, rows_.series.value.size()), rows_); }

  // Where times were measured, frames are placed by them; frames missing by these times become gaps.
  LoopLevel clock() {
    LoopLevel out;
    out.level = "clock and frames", out.unit = "ms off the grid";
    const FrameTimes& times = rows_.times;
    clock_.times_known = times.are_measured();
    // Times are nanoseconds: less is rounding.
    out.residual_before = times.jitter_rms_s < 1e-9 ? 0.0 : 1e3 * times.jitter_rms_s;
    const bool is_moved = times.are_measured() && times.are_uneven(rows_.series.rate_hz);
    out.residual_after = is_moved ? 0.0 : out.residual_before;
    if (is_moved) {
      out.findings.push_back({fmt::format("the frames lie {:.3g} ms rms off an even grid", 1e3 * times.jitter_rms_s),
                              "the displacements are interpolated to the grid's instants"});
    }
    if (times.n_missing > 0) {
      out.findings.push_back(
          {fmt::format("{} of {} frames are missing", times.n_missing, times.n_missing + times.number.size()),
           "they are gaps of the record"});
    }
    if (times_.n_repeated > 0) {
      out.findings.push_back({fmt::format("{} frames show the picture before them", times_.n_repeated),
                              "they were left out when the clip was read"});
    }
    out.left = clock_.times_known
                   ? "the times were measured: nothing of the clock is looked for below"
                   : "the frames are counted: lost, repeated and late ones are looked for in the response";
    out.left += last_part(times.number.size(), n_frames_, rows_.series.rate_hz);
    return out;
  }

  LoopLevel observation() {
    const std::string name = "observation";
    if (!inputs_.config) return skipped(name, "it needs the run's configuration (--config): regions and camera");
    if (!tracks_) return skipped(name, "there is no " + tracks_path_ + " (report.tracks)");
    tell("fitting the model of the points' places");
    const int points_per_region = inputs_.config->closure.points_per_region;
    const std::size_t most_frames = frames_in(inputs_.most_cells, n_thinned(*tracks_, points_per_region));
    std::unique_ptr<core::closure::ObservationLevel> level;
    try {
      TracksRecord record = thinned(tracks_record(*tracks_, *inputs_.config, most_frames), points_per_region);
      level = std::make_unique<core::closure::ObservationLevel>(std::move(record.record));
    } catch (const std::invalid_argument& e) {
      return skipped(name, e.what());
    } catch (const drivers::FileError& e) {  // too long, or too large for the memory that is left
      return skipped(name, e.what());
    }
    core::closure::ClosureOptions options;
    options.n_surrogates = core::closure::ObservationLevel::kSurrogates;
    options.seed = inputs_.seed;
    options.least_gain = inputs_.config->closure.least_px;
    options.progress = inputs_.progress;
    ClosureResult result = core::closure::close_loop(*level, options);
    name_motors(*inputs_.config, motors_, level->state().record(), result);
    LoopLevel out = level_of(name, std::move(result));
    const DeclaredObservation declared =
        declared_observation(*inputs_.config, camera_of_tracks(*tracks_, *inputs_.config));
    const CorrectionSet corrections = corrections_of(*out.result, declared.camera);
    for (std::size_t i = 0; i < out.findings.size(); ++i) {
      if (is_corrected(out.result->steps[i]))
        out.findings[i].repair = "the points are corrected and the displacements measured again";
    }
    if (!corrections.words.empty()) {
      rows_ = rows_of_tracks(*inputs_.config, *tracks_, corrections);
      keep_end();
      series_ = on_grid(rows_);
    }
    out.left += last_part(most_frames, n_frames_, rows_.series.rate_hz);
    return out;
  }

  LoopLevel response() {
    const std::string name = "response";
    tell("predicting the channels");
    ResponseOptions options;
    options.clock = clock_;
    options.n_surrogates = inputs_.n_surrogates;
    options.seed = inputs_.seed;
    options.progress = inputs_.progress;
    try {
      ResponseAnalysis found = analyse_response(series_, options);
      LoopLevel out = level_of(name, std::move(found.result));
      for (std::size_t i = 0; i < out.findings.size() && i < found.repairs.size(); ++i)
        out.findings[i].repair = found.repairs[i];
      series_ = std::move(found.after);
      return out;
    } catch (const std::invalid_argument& e) {
      return skipped(name, e.what());
    }
  }

  // Compares the declared structure with the present modes.
  LoopLevel structure(const LoopModes::Corrected& modes) {
    const std::string name = "structure";
    if (!inputs_.structure) return skipped(name, "no structure is declared (--structure)");
    tell("fitting the declared structure");
    try {
      core::closure::ClosureOptions options;
      options.seed = inputs_.seed;
      options.progress = inputs_.progress;
      MeasuredModes measured =
          paired_with(*inputs_.structure, reference_modes(modes.estimate, modes.channel_names, *inputs_.structure));
      StructureFinding found = compare_structure(*inputs_.structure, std::move(measured), options);
      LoopLevel out = level_of(name, std::move(found.result));
      for (LoopLevel::Finding& finding : out.findings) finding.repair = "the structural model has it from now on";
      for (StructurePicture& one : structure_level_pictures(*found.level, *out.result, *inputs_.structure))
        out.pictures.push_back({std::move(one.title), std::move(one.svg)});
      return out;
    } catch (const std::invalid_argument& e) {
      return skipped(name, e.what());
    }
  }

  void tell(const std::string& words) const {
    if (inputs_.progress) inputs_.progress({words});
  }

  const LevelLoopInputs& inputs_;
  std::string tracks_path_, series_path_;
  std::optional<drivers::TracksFile> tracks_;
  MeasuredRows rows_;
  std::size_t n_frames_ = 0;  // of the whole record
  core::RecordingTimes times_;
  SeriesClock clock_;
  core::MotorLines motors_;  // as the aircraft stated them
  ChannelSeries as_measured_, series_;
};

}  // namespace

LoopResult close_levels(const LevelLoopInputs& inputs) { return LevelLoop(inputs).run(); }

}  // namespace app
