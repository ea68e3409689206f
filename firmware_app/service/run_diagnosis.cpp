#include "firmware_app/service/run_diagnosis.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <sstream>
#include <stdexcept>
#include <string>

#include "drivers/storage/structure_file.h"
#include "firmware_app/replay/level_loop.h"
#include "firmware_app/report/loop_report.h"
#include "firmware_app/report/structure_section.h"

namespace app {

core::structure::DeclaredFrame declared_structure(const AppConfig& config) {
  if (config.closure.structure.empty()) return {};
  return drivers::read_structure(config.closure.structure);
}

void check_structure(const AppConfig& config) {
  try {
    (void)declared_structure(config);
  } catch (const std::exception& e) {
    throw ConfigError(std::string("closure.structure: ") + e.what());
  }
}

void diagnose_run(const AppConfig& config, const Pipeline::Outcome& outcome, const std::function<bool()>& goes_on) {
  if (outcome.page.empty() || !config.report.tracks || config.closure.adopt == ClosureAdopt::kOff) {
    if (!config.closure.structure.empty())
      spdlog::warn("closure.structure was not compared: that needs a report with tracks, and closure.adopt not off");
    return;
  }
  try {
    LevelLoopInputs inputs;
    inputs.folder = config.report.directory;
    inputs.config = config;
    if (!config.closure.structure.empty()) inputs.structure = declared_structure(config);
    inputs.progress = [&goes_on](const core::closure::LoopProgress&) {
      if (!goes_on()) throw std::runtime_error("stopped");
    };
    const core::closure::LoopResult result = close_levels(inputs);
    write_loop_report(inputs.folder, result);
    add_structure_to_report(inputs.folder, result);
    std::istringstream lines(loop_text(result));
    for (std::string line; std::getline(lines, line);) spdlog::info("{}", line);
  } catch (const std::exception& e) {
    spdlog::info("residual diagnosis over all levels: none: {}", e.what());
  }
}

}  // namespace app
