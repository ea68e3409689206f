// hovermodal export: a run in the formats of other programs.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "drivers/exchange/mat_writer.h"
#include "drivers/exchange/mcap_writer.h"
#include "drivers/exchange/modes_csv.h"
#include "drivers/exchange/uff_writer.h"
#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/export/run_folder.h"
#include "tools/hovermodal/named_file.h"

namespace tools {
namespace {

constexpr const char* kExportHelp =
    "A run in the formats of other programs: modes with sigma, displacements, spectra, correlations\n"
    "  hovermodal export out --to uff --out out.uff     # modal analysis programs, pyuff\n"
    "  hovermodal export out --to mat --out out.mat     # MATLAB, Octave, scipy.io.loadmat\n"
    "  hovermodal export out --to csv --out modes.csv   # a table of the modes, one line each\n"
    "  hovermodal export out --to mcap --out out.mcap   # Foxglove: plot /displacement.channel.roof\n"
    "RUN is the folder that --report wrote, or its modal.json. Of displacements.csv the spectra are computed as the\n"
    "run did; tracks.csv gives the places. What is not there is left out, with a note.\n"
    "uff: data sets 151 164 15 82 55 58; shapes have 6 digits, functions 13. Missing samples are left out.\n"
    "mat: version 5; NaN is missing or unknown. mcap: JSON with JSON schemas; null is missing or unknown.\n"
    "Lengths are in the run's unit (mm, or px without a scale), x to the right, y up, from the image's first corner.";

struct ExportOptions {
  std::string run, format, out;
  bool force = false;
  Answer answer;
};

void write(const drivers::ExchangeRun& run, const ExportOptions& options) {
  if (options.format == "uff") return drivers::write_uff(run, options.out);
  if (options.format == "mat") return drivers::write_mat(run, options.out);
  if (options.format == "csv") return drivers::write_modes_csv(run, options.out);
  drivers::write_mcap(run, options.out);
}

std::string export_json(const LoadedRun& loaded, const ExportOptions& options) {
  const nlohmann::ordered_json out{{"out", options.out},
                                   {"modes", loaded.run.modes.size()},
                                   {"channels", loaded.run.channels.size()},
                                   {"samples", loaded.run.t_s.size()},
                                   {"spectra", loaded.run.spectra.size()},
                                   {"remarks", loaded.remarks}};
  return drivers::to_json_text(out).text;
}

void export_run(const ExportOptions& options) {
  require_free(options.out, options.force);
  const LoadedRun loaded = load_run(options.run);
  for (const std::string& remark : loaded.remarks) options.answer.note("note: {}\n", remark);
  if (options.format == "csv" && loaded.run.modes.empty()) {
    throw std::invalid_argument(options.run +
                                ": no modes, and a csv has nothing else; --to uff, mat and mcap have series");
  }
  write(loaded.run, options);
  options.answer.document(export_json(loaded, options));
  options.answer.text("{}: {} modes, {} channels, {} samples, {} spectra\n", options.out, loaded.run.modes.size(),
                      loaded.run.channels.size(), loaded.run.t_s.size(), loaded.run.spectra.size());
}

}  // namespace

void add_export(drivers::Command& app) {
  auto options = std::make_shared<ExportOptions>();
  drivers::Command command = app.subcommand("export", kExportHelp);
  command.option("run", options->run, "Folder of a run, or its modal.json").required().type_name("RUN");
  command.option("--to", options->format, "Format").required().one_of({"uff", "mat", "csv", "mcap"});
  command.option("--out", options->out, "File to write").required().type_name("FILE");
  add_force_option(command, options->force);
  add_answer_options(command, options->answer, "what was written");
  command.on_run([options] { export_run(*options); });
}

}  // namespace tools
