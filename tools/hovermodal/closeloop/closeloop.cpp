// hovermodal closeloop: what a model leaves, traced to what it lacks.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "core/closure/closure_loop.h"
#include "core/closure/structure_level.h"
#include "drivers/storage/json.h"
#include "drivers/storage/structure_file.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/closure_json.h"
#include "tools/hovermodal/closeloop/closeloop_tracks.h"
#include "tools/hovermodal/closeloop/reference.h"
#include "tools/hovermodal/closeloop/words.h"
#include "tools/hovermodal/commands.h"

namespace tools {
namespace {

struct Options {
  std::string structure, reference, check, report;
  std::uint64_t seed = 1;
  std::size_t n_surrogates = 333;
  TracksLoop tracks;
};

std::string help() {
  return "Close the loop: fit a structural model to measured modes, find what it cannot explain, and the effect it "
         "lacks\n"
         "\n"
         "  1. Write down what is known, in frame.yaml:   structure: {kind: shear_frame, storeys: 6}\n"
         "  2. Measured modes: modal.json of a run, or modes.csv with a column frequency_hz (lowest mode first)\n"
         "  3. hovermodal closeloop --structure frame.yaml --reference out/modal.json --report loop\n"
         "\n"
         "The model is fitted; what is left is tested against the stated noise. Each candidate effect is fitted as "
         "well\n"
         "and judged by modes that its fit did not see (one left out at a time). The best is adopted where its gain "
         "is\n"
         "above what chance reaches on made-up data without it, at least halves that error, and its numbers can be "
         "true;\n"
         "then all is fitted again, until nothing helps. Effects that would do as well are named beside it: then the\n"
         "data do not tell which is the cause.\n"
         "\nWith --record the points' tracks themselves are modelled instead: motion of each region and of the camera; "
         "what\n"
         "that leaves is traced to rotation, lens, readout time, the tracker, rotors, or told as a pattern of its "
         "own:\n"
         "  hovermodal closeloop --record out --config flight.yaml --report loop\n"
         "\nKeys of frame.yaml, under `structure:`\n" +
         drivers::structure_keys_help() +
         "\nColumns of modes.csv: frequency_hz or frequency_rad_s; optional: mode (number from 1), sigma_hz, one a "
         "floor\n"
         "(named as in `floors`) with the shape. The report holds closure.json and closure_modes.svg.";
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw std::runtime_error("--report " + folder + ": cannot be made; name a folder that may be written");
}

std::string check_text(const core::closure::StructureLevel& level) {
  if (level.check().empty()) return {};
  std::string out = "modes that no fit saw (--check): predicted, given, error\n";
  const auto modes = level.model_modes();
  for (const auto& mode : level.check()) {
    const double hz = modes.frequency_hz(mode.number - 1);
    out += fmt::format("{:4}  {:10.4f}  {:10.4f}  {:+7.3f} %\n", mode.number, hz, mode.frequency_hz,
                       100.0 * (hz / mode.frequency_hz - 1.0));
  }
  return out;
}

void run_tracks(const Options& options) {
  if (!options.structure.empty()) throw std::invalid_argument("--structure is for modes; --record is a record");
  if (!is_tracks_record(options.tracks.record))
    throw std::invalid_argument("--record " + options.tracks.record + ": neither a folder of a run nor a tracks.csv");
  if (!options.report.empty()) make_folder(options.report);
  TracksLoop request = options.tracks;
  request.reference = options.reference, request.report = options.report, request.seed = options.seed;
  close_tracks(request);
}

void run(const Options& options) {
  if (!options.tracks.record.empty()) return run_tracks(options);
  if (options.structure.empty() || options.reference.empty())
    throw std::invalid_argument("closeloop needs --structure with --reference, or --record");
  const core::structure::DeclaredFrame declared = drivers::read_structure(options.structure);
  auto reference = read_reference(options.reference, declared);
  auto check =
      options.check.empty() ? std::vector<core::structure::ReferenceMode>{} : read_reference(options.check, declared);
  const auto make_level = [&] {
    try {
      return std::make_unique<core::closure::StructureLevel>(declared, std::move(reference), std::move(check));
    } catch (const std::invalid_argument& error) {
      throw drivers::FileError(options.reference + (options.check.empty() ? "" : " or " + options.check) + ": " +
                               error.what());
    }
  };
  const auto level = make_level();
  if (!options.report.empty()) make_folder(options.report);
  core::closure::ClosureOptions loop;
  loop.n_surrogates = options.n_surrogates;
  loop.seed = options.seed;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal) loop.progress = [](const std::string& words) { fmt::print(stderr, "\r\033[K{}", words); };
  const core::closure::ClosureResult result = core::closure::close_loop(*level, loop);
  if (terminal) fmt::print(stderr, "\r\033[K");
  std::vector<std::string> meanings;
  for (std::size_t i = 0; i < result.steps.size(); ++i) meanings.push_back(level->meaning(i));
  fmt::print("{}{}", closure_text(result, meanings), check_text(*level));
  if (options.report.empty()) return;
  const std::filesystem::path folder = options.report;
  drivers::write_file_atomically((folder / "closure.json").string(), app::closure_json(result));
  drivers::write_file_atomically((folder / "closure_modes.svg").string(), app::closure_modes_svg(result));
  fmt::print("{} written\n", (folder / "closure.json").string());
}

}  // namespace

void add_closeloop(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("closeloop", help());
  command->add_option("--record", options->tracks.record, "A record in place of modes: tracks.csv, or a run's folder")
      ->type_name("DIR|FILE");
  command->add_option("--config", options->tracks.config, "Of --record: configuration of that run")->type_name("FILE");
  command->add_option("--set", options->tracks.overrides, "Of --record: override one key of it")
      ->type_name("section.key=value")
      ->take_all();
  command->add_option("--structure", options->structure, "What is known of the structure")->type_name("FILE.yaml");
  command->add_option("--reference", options->reference, "Measured modes: modal.json or modes.csv")->type_name("FILE");
  command
      ->add_option("--check", options->check, "Other measured modes, which no fit sees: the model's error against them")
      ->type_name("FILE");
  command->add_option("--report", options->report, "Folder for closure.json and closure_modes.svg")->type_name("DIR");
  command->add_option("--surrogates", options->n_surrogates, "Made-up records a step, to learn what chance reaches")
      ->check(CLI::Range(8, 100000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Of those records")->capture_default_str();
  command->callback([options] { run(*options); });
}

}  // namespace tools
