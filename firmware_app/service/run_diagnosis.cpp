#include "firmware_app/service/run_diagnosis.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <sstream>
#include <string>

#include "drivers/storage/structure_file.h"
#include "firmware_app/chain/end_when_stopped.h"
#include "firmware_app/replay/level_loop.h"
#include "firmware_app/report/loop_report.h"
#include "firmware_app/report/structure_section.h"

namespace app {

std::optional<core::structure::DeclaredFrame> declared_structure(const AppConfig& config) {
  if (config.closure.structure.empty()) return std::nullopt;
  try {
    return drivers::read_structure(config.closure.structure);
  } catch (const std::exception& e) {
    throw ConfigError(std::string("closure.structure: ") + e.what());
  }
}

void diagnose_run(const Pipeline& pipeline, const Pipeline::Outcome& outcome, const std::function<bool()>& goes_on) {
  const AppConfig& config = pipeline.config();
  if (outcome.page.empty() || !config.report.tracks || config.closure.adopt == ClosureAdopt::kOff) {
    if (pipeline.structure())
      spdlog::warn("closure.structure was not compared: that needs a report with tracks, and closure.adopt not off");
    return;
  }
  try {
    LevelLoopInputs inputs;
    inputs.folder = config.report.directory;
    inputs.config = config;
    inputs.structure = pipeline.structure();
    inputs.progress = end_when_stopped(goes_on);
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
