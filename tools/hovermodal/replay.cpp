// hovermodal replay, report: the service's chain on recorded tracks, starting with geometry.
#include <fmt/core.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/host/command_line.h"
#include "firmware_app/replay/analysis.h"
#include "firmware_app/report/page/report_page.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/modes_text.h"
#include "tools/hovermodal/simulate/progress.h"

namespace tools {

namespace {

struct Options {
  std::vector<std::string> records, overrides;
  std::string tracks, config, report;
  Answer answer;
};

void show(const app::TracksResult& result, const Options& options) {
  options.answer.document(modes_json(result.estimate, result.channels, result.method));
  for (const std::string& change : result.changes) options.answer.note("{}\n", change);
  options.answer.text("{}", modes_text(result.estimate, result.channels));
  if (!options.report.empty()) options.answer.text("open {}/{}\n", options.report, app::kReportName);
}

// Shown once two seconds are over. `per_unit`: of what is counted.
std::function<void(std::uint64_t, std::uint64_t)> progress_of(const Options& options, const std::string& unit,
                                                              std::uint64_t per_unit) {
  if (!options.answer.tells()) return {};
  const auto shown = std::make_shared<std::unique_ptr<Progress>>();
  return [shown, unit, per_unit](std::uint64_t done, std::uint64_t total) {
    constexpr double kSilent_s = 2.0;
    if (!*shown) *shown = std::make_unique<Progress>("replay", total / per_unit, unit);
    if ((*shown)->elapsed_s() > kSilent_s) (*shown)->update(done / per_unit);
  };
}

void replay_records(const Options& options) {
  const app::RecordsResult result = app::replay_records(options.records, {options.config, options.overrides},
                                                        options.report, progress_of(options, "kB", 1000));
  for (const std::string& remark : result.remarks) options.answer.note("{}\n", remark);
  show(result.tracks, options);
}

void replay(const Options& options) {
  if (options.records.empty() == options.tracks.empty())
    throw std::invalid_argument("replay: give records (LOG ...) or --tracks FILE");
  if (!options.records.empty()) return replay_records(options);
  if (options.config.empty()) throw std::invalid_argument("replay: --tracks needs the --config of the run");
  const app::AppConfig config = app::load_config(options.config, options.overrides);
  show(app::replay_tracks(config, options.tracks, options.report, progress_of(options, "frames", 1)), options);
}

// "flights/bridge_run0007_000.lcm" -> "flights/bridge_run0007_report"
std::string report_folder(const std::string& record) {
  std::filesystem::path path(record);
  std::string stem = path.stem().string();
  if (const std::size_t at = stem.rfind('_'); at != std::string::npos && at > 0) stem.resize(at);
  return (path.parent_path() / (stem + "_report")).string();
}

void add_record_options(drivers::Command& command, Options& options, bool required) {
  command.option("record", options.records, "First file of each recorded run; the files that follow it are found")
      .required(required)
      .type_name("LOG");
  command.option("--config", options.config, "Configuration to use; default for a record: the recorded one")
      .type_name("FILE");
  command.option("--set", options.overrides, "Override one key").type_name("section.key=value").repeated();
  add_answer_options(command, options.answer, "the modes, as modal.json has them,");
}

}  // namespace

void add_replay(drivers::Command& app) {
  auto options = std::make_shared<Options>();
  drivers::Command command = app.subcommand(
      "replay",
      "Run geometry, spectra and identification again on a record of the service, or on a tracks.csv\n"
      "  hovermodal replay flights/bridge_run0007_000.lcm --report again\n"
      "      a run that was recorded (record.directory): the same estimates, to the last bit\n"
      "  hovermodal replay flights/bridge_run0007_000.lcm --set method=paper\n"
      "      the same flight, seen by the published chain\n"
      "  hovermodal replay flights/bridge_run000[789]_000.lcm --report together\n"
      "      several flights of one view: their spectra are added up, to one estimate\n"
      "  hovermodal replay --tracks out/tracks.csv --config flight.yaml --set method=paper --report again");
  command.option("--tracks", options->tracks, "tracks.csv of a run or of `simulate --tracks-only`").type_name("FILE");
  add_record_options(command, *options, false);
  command.option("--report", options->report, "Folder for the report").type_name("DIR");
  command.on_run([options] { replay(*options); });
}

void add_report(drivers::Command& app) {
  auto options = std::make_shared<Options>();
  drivers::Command command =
      app.subcommand("report",
                     "The report of a recorded run: pictures and page, as the service makes them\n"
                     "  hovermodal report flights/bridge_run0007_000.lcm");
  add_record_options(command, *options, true);
  command.option("--out", options->report, "Folder for it; default: beside the record, ..._report").type_name("DIR");
  command.on_run([options] {
    if (options->report.empty()) options->report = report_folder(options->records.front());
    replay_records(*options);
  });
}

}  // namespace tools
