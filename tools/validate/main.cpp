// hovermodal-validate: the command line of the statistical validation.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "drivers/host/command_line.h"
#include "tools/validate/checks.h"

namespace tools {
namespace {

using Options = ValidateOptions;

constexpr std::array<std::pair<const char*, unsigned>, 9> kOptions{{{"--first-seed", kSeed},
                                                                    {"--seeds", kSeeds},
                                                                    {"--frames", kFrames},
                                                                    {"--threads", kThreads},
                                                                    {"--duration", kDuration},
                                                                    {"--effect", kEffect},
                                                                    {"--strength", kStrength},
                                                                    {"--flight", kFlight},
                                                                    {"--report", kReport}}};

std::string meanings() {
  std::string text = "What is checked";
  for (const Check& check : all_checks()) text += fmt::format("\n{}: {}", check.name, check.meaning);
  return text;
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Check& check : all_checks()) all.emplace_back(check.name);
  return all;
}

void run(const drivers::Command& command, const Options& options) {
  const Check& check = *std::find_if(all_checks().begin(), all_checks().end(),
                                     [&](const Check& one) { return options.what == one.name; });
  for (const auto& [option, taken_by] : kOptions) {
    if (!command.given(option) || (check.takes & taken_by) != 0U) continue;
    throw std::invalid_argument(fmt::format("{} has no use for {}; leave it out", check.name, option));
  }
  check.print(options);
}

void add_options(drivers::Command& program, Options& options) {
  program.option("what", options.what, meanings()).required().one_of(names());
  program.option("--first-seed", options.first_seed, "Seed of the first record, or of the only scene")
      .range(1, 1000000)
      .show_default();
  program.option("--seeds", options.n_seeds, "Records, one for each seed from the first on")
      .range(1, 10000)
      .show_default();
  program.option("--frames", options.n_frames, "klt: frames of a minute that are drawn").range(1, 1499).show_default();
  program.option("--threads", options.n_threads, "Threads, where records are made or frames drawn")
      .range(1, 256)
      .show_default();
  program.option("--duration", options.duration_s, "geometry, closure-tracks: seconds; 0 = that of the figure")
      .range(0.0, 3600.0);
  program.option("--effect", options.effect, "closure-tracks, -clip, -live: this effect only").type_name("NAME");
  program
      .option("--strength", options.strength,
              "closure-tracks: this strength only; 0 = all; changes-flights: share of the stiffness")
      .range(0.0, 100.0);
  program
      .option("--flight", options.flight,
              "null, geometry, closure-tracks-foreign: the recorded flight that moves the camera")
      .type_name("FILE");
  program
      .option("--report", options.report,
              "table1: folder for the pictures; geometry-pixels, changes: for clips and reports")
      .type_name("DIR");
}
}  // namespace
}  // namespace tools

int main(int argc, char** argv) {
  drivers::CommandLine program{
      "hovermodal-validate: the statistical validation of hovermodal\n"
      "Checks the simulator against theory, the identification and the search for missing effects against the "
      "simulator's "
      "truth. The figure scripts in tools/figures call it; it is not installed."};
  tools::Options options;
  tools::add_options(program, options);
  try {
    if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
    tools::run(program, options);
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "hovermodal-validate: %s\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "hovermodal-validate: %s\n", e.what());
    return 1;
  }
  return 0;
}
