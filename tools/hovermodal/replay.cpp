// hovermodal replay: the service's chain on recorded tracks, from geometry on.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "firmware_app/analysis.h"
#include "firmware_app/report/page/report_page.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/modes_text.h"

namespace tools {

void add_replay(CLI::App& app) {
  struct Options {
    std::string tracks, config, report;
    std::vector<std::string> overrides;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "replay",
      "Run geometry, spectra and identification again on a tracks.csv, with any configuration\n"
      "  hovermodal replay --tracks out/tracks.csv --config flight.yaml --set method=paper --report again");
  command->add_option("--tracks", options->tracks, "tracks.csv of a run or of `simulate --tracks-only`")
      ->required()
      ->type_name("FILE");
  command->add_option("--config", options->config, "Configuration of the run")->required()->type_name("FILE");
  command->add_option("--set", options->overrides, "Override one key")->type_name("section.key=value")->take_all();
  command->add_option("--report", options->report, "Folder for the report")->type_name("DIR");
  command->callback([options] {
    const app::AppConfig config = app::load_config(options->config, options->overrides);
    const app::TracksResult result = app::replay_tracks(config, options->tracks, options->report);
    for (const std::string& change : result.changes) fmt::print("{}\n", change);
    fmt::print("{}", modes_text(result.estimate, result.channels));
    if (!options->report.empty()) fmt::print("open {}/{}\n", options->report, app::kReportName);
  });
}

}  // namespace tools
