// hovermodal closeloop --run out: residual diagnosis over all levels of one run.
#include "tools/hovermodal/closeloop/closeloop_run.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "drivers/storage/structure_file.h"
#include "firmware_app/replay/level_loop.h"
#include "firmware_app/report/earlier_files.h"
#include "firmware_app/report/loop_report.h"
#include "tools/hovermodal/closeloop/series_modes.h"

namespace tools {

void close_run(const RunLoop& request) {
  app::LevelLoopInputs inputs;
  inputs.folder = request.folder;
  if (!std::filesystem::is_directory(request.folder))
    throw std::invalid_argument("--run " + request.folder + ": is no folder; name the report folder of a run");
  if (!request.config.empty()) inputs.config = app::load_config(request.config, request.overrides);
  inputs.bases = request.bases;
  if (!request.structure.empty()) inputs.structure = drivers::read_structure(request.structure);
  for (const KnownMode& mode : read_reference_modes(request.reference))
    inputs.reference_hz.push_back(mode.frequency_hz);
  inputs.max_frequency_hz = request.max_frequency_hz;
  inputs.seed = request.seed;
  const core::closure::LoopResult result = [&] {
    const ProgressLine line(request.answer);
    inputs.progress = line.teller();
    return app::close_levels(inputs);
  }();
  request.answer.document(app::loop_json(result));
  request.answer.text("{}", app::loop_text(result));
  const std::string& folder = request.report.empty() ? request.folder : request.report;
  app::keep_earlier(folder, "loop", {"loop.html", "loop.json"});
  app::write_loop_report(folder, result);
  request.answer.text("open {}\n", (std::filesystem::path(folder) / "loop.html").string());
}

}  // namespace tools
