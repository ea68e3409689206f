// hovermodal closeloop: attributes the residual of a model to the effect that it lacks.
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "drivers/host/command_line.h"
#include "drivers/storage/structure_file.h"
#include "drivers/storage/text_file.h"
#include "tools/hovermodal/closeloop/closeloop_run.h"
#include "tools/hovermodal/closeloop/closeloop_series.h"
#include "tools/hovermodal/closeloop/closeloop_structure.h"
#include "tools/hovermodal/closeloop/closeloop_tracks.h"
#include "tools/hovermodal/closeloop/closeloop_turning.h"
#include "tools/hovermodal/commands.h"

namespace tools {
namespace {

struct Options {
  std::string structure, check, run;
  LoopRequest loop;
  SeriesLoop series;
  TracksLoop tracks;
  GyroClipOptions clip;
};

std::string help() {
  return "Residual diagnosis (\"closing the loop\"): fit a structural model to measured modes, find the effect that it "
         "lacks\n"
         "\n"
         "  1. Declare the structure in frame.yaml:   structure: {kind: shear_frame, storeys: 6}\n"
         "  2. Measured modes: modal.json of a run, or modes.csv with a column frequency_hz (lowest mode first)\n"
         "  3. hovermodal closeloop --structure frame.yaml --reference out/modal.json --report loop\n"
         "\n"
         "The model is fitted and its residual tested against the stated noise. Each candidate effect is fitted as "
         "well\n"
         "and scored by cross-validation: on modes excluded from its fit, one at a time. The best is adopted if its "
         "gain\n"
         "exceeds the chance threshold (from surrogate data without the effect), at least halves that error, and its\n"
         "numbers are plausible; then all are fitted again, until no effect helps. Effects that would explain the "
         "data\n"
         "as well are named beside it: the data then do not determine which is the cause.\n"
         "\nWith --run all levels of a finished run are gone through, each on what the one before repaired: clock and "
         "frames,\n"
         "observation (tracks), response (displacements) and, with --structure, the structure. At the end stand the "
         "residuals\n"
         "and the modes before and after, against --reference or else the two halves of the record; loop.html, "
         "loop.json:\n"
         "  hovermodal closeloop --run out --config flight.yaml\n"
         "\nWith --record the points' tracks themselves are modelled instead: motion of each region and of the camera. "
         "The\n"
         "residual is attributed to rotation, lens, readout time, the tracker or rotors, or reported as an unnamed "
         "pattern:\n"
         "  hovermodal closeloop --record out --config flight.yaml --report loop\n"
         "\nKeys of frame.yaml, under `structure:`\n" +
         drivers::structure_keys_help() +
         "\nColumns of modes.csv: frequency_hz or frequency_rad_s; optional: mode (number from 1), sigma_hz, "
         "damping_ratio and\n"
         "damping_sigma (the mechanism of damping, from damping over frequency), one a floor\n"
         "(named as in `floors`) with the shape. The report consists of closure.json and closure_modes.svg.\n"
         "\nA record in place of modes (tables as for `hovermodal identify`):\n"
         "  hovermodal closeloop --record out/displacements.csv --rate-hz 20 --clock readings.csv --report loop\n"
         "      the frames' times against a filmed clock: rate, lost frames; modes before and after\n"
         "  ... --free-decay    a structure pulled and released: does one linear mode explain every decay?\n"
         "  hovermodal closeloop --record out/displacements.csv --base base --report loop\n"
         "      lost, repeated and late frames, drift and softening of the frequencies\n"
         "  hovermodal closeloop --record table.csv --quantity a --input ground --input-unknown --report loop\n"
         "      are some of the modes peaks of the ground's motion?\n"
         "  hovermodal closeloop --record ground.csv floor1.csv floor2.csv --quantity a --input-record ground\n"
         "      --reference modal.json    loggers with separate clocks\n"
         "\nA clip of a camera that is rotated beside a gyro (files as for `hovermodal readout`):\n"
         "  hovermodal closeloop --clip frames --stamps framestamp.txt --gyro gyro.txt --focal-px 574 --report loop\n"
         "      does the camera rotate, and are its lines read one after the other?";
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw std::runtime_error("--report " + folder + ": cannot be made; name a folder that may be written");
}

void run_record(Options options) {
  options.series.request.is_quiet = options.loop.answer.quiet;
  const LoopRequest& loop = options.loop;
  if (!options.structure.empty())
    throw std::invalid_argument("--structure applies to modes, not to --record: leave one out");
  if (!loop.report.empty()) make_folder(loop.report);
  if (loop.records.size() > 1 || !is_tracks_record(loop.records.front())) return close_series(loop, options.series);
  TracksLoop request = options.tracks;
  request.record = loop.records.front();
  request.reference = loop.reference, request.report = loop.report, request.seed = loop.seed;
  request.answer = loop.answer;
  close_tracks(request);
}

void run_levels(const Options& options) {
  if (!options.loop.records.empty() || !options.clip.clip.empty() || !options.check.empty())
    throw std::invalid_argument("--run cannot be combined with --record, --clip or --check");
  if (!options.loop.report.empty()) make_folder(options.loop.report);
  RunLoop request;
  request.folder = options.run, request.config = options.tracks.config, request.overrides = options.tracks.overrides;
  request.structure = options.structure, request.reference = options.loop.reference;
  request.report = options.loop.report, request.bases = options.series.request.bases;
  request.max_frequency_hz = options.series.max_frequency_hz, request.seed = options.loop.seed;
  request.answer = options.loop.answer;
  close_run(request);
}

void run(const Options& options) {
  if (!options.run.empty()) return run_levels(options);
  if (!options.clip.clip.empty()) {
    if (!options.loop.records.empty() || !options.structure.empty())
      throw std::invalid_argument("--clip cannot be combined with --record or --structure");
    if (!options.loop.report.empty()) make_folder(options.loop.report);
    return close_turning(options.loop, options.clip);
  }
  if (!options.loop.records.empty()) return run_record(options);
  if (options.structure.empty() || options.loop.reference.empty())
    throw std::invalid_argument("closeloop needs --run, --structure with --reference, --record, or --clip");
  if (!options.loop.report.empty()) make_folder(options.loop.report);
  close_structure(options.loop, options.structure, options.check);
}

}  // namespace

void add_closeloop(drivers::Command& app) {
  auto options = std::make_shared<Options>();
  drivers::Command command = app.subcommand("closeloop", help());
  command
      .option("--run", options->run,
              "Report folder of a run: all levels, one after the other, each on what the one before repaired")
      .type_name("DIR");
  command
      .option("--record", options->loop.records,
              "Record in place of modes: a run's folder or tracks.csv, or tables of samples")
      .type_name("DIR|FILE.csv...");
  command.option("--config", options->tracks.config, "For tracks: configuration of that run").type_name("FILE");
  command.option("--set", options->tracks.overrides, "For tracks: override one key of that configuration")
      .type_name("section.key=value")
      .repeated();
  command.option("--structure", options->structure, "Declared structural model").type_name("FILE.yaml");
  command.option("--reference", options->loop.reference, "Measured modes: modal.json or modes.csv").type_name("FILE");
  command
      .option("--check", options->check,
              "Other measured modes, excluded from the fit: prints the model's error against them")
      .type_name("FILE");
  command.option("--report", options->loop.report, "Folder for closure.json and pictures").type_name("DIR");
  command.option("--surrogates", options->loop.n_surrogates, "Surrogate records per step, for the chance threshold")
      .range(8, 100000)
      .show_default();
  command.option("--seed", options->loop.seed, "Seed of the surrogates").show_default();
  add_answer_options(command, options->loop.answer, "closure.json (with --run: loop.json)");
  add_series_options(command, options->series);
  add_gyro_clip_options(command, options->clip, false);
  command.on_run([options] { run(*options); });
}

}  // namespace tools
