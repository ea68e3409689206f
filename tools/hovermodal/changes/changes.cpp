// hovermodal changes: the modes of one structure over many flights, tested for a change.
#include <filesystem>
#include <memory>
#include <string>

#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "firmware_app/report/earlier_files.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/changes/mode_histories.h"
#include "tools/hovermodal/commands.h"

namespace tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChangesHelp =
    "Compare the modes of many flights over time, and test them for a change\n"
    "  hovermodal changes flights.csv --out changes\n"
    "  hovermodal changes together/flights          (folders that `batch` left, in the order of their names)\n"
    "flights.csv has a line per flight:\n"
    "  report,date,temperature_c\n"
    "  2026-03-31/report,2026-03-31T14:05,8.5\n"
    "report: a modal.json or its folder, relative to the table; date: or day, a number; temperature_c: may be left "
    "out.\n"
    "Frequency, damping and every component of a shape are tested for one step or one trend, at equal temperature\n"
    "where it is known. A structure that did not change is reported as changed in one of a hundred such tables at\n"
    "most. Six flights are needed, three on either side of a change. A flight all of whose frequencies lie apart from\n"
    "the others' by one factor contradicts them (its clock or frame rate): it is named and left out.\n"
    "Exit code: 0 no change, 3 a change, 1 or 2 an error. It leaves changes.json and changes.svg in --out.";

struct ChangesOptions {
  std::string flights, out;
  Answer answer;
};

void run_changes(const ChangesOptions& options) {
  const ModeHistories result = find_changes(read_flights(options.flights));
  const std::string json = changes_json(result);
  if (!options.out.empty()) {
    fs::create_directories(options.out);
    app::keep_earlier(options.out, "changes", {"changes.json", "changes.svg"});
    drivers::write_file_atomically((fs::path(options.out) / "changes.json").string(), json);
    if (const std::string svg = changes_svg(result); !svg.empty())
      drivers::write_file_atomically((fs::path(options.out) / "changes.svg").string(), svg);
  }
  options.answer.document(json);
  options.answer.text("{}", changes_text(result));
  if (result.is_changed()) throw ChangeFound();
}

}  // namespace

void add_changes(drivers::Command& app) {
  auto options = std::make_shared<ChangesOptions>();
  drivers::Command command = app.subcommand("changes", kChangesHelp);
  command.option("flights", options->flights, "Table of the flights, or a folder with a folder for each")
      .required()
      .type_name("FLIGHTS");
  command.option("--out", options->out, "Folder for changes.json and changes.svg").type_name("DIR");
  add_answer_options(command, options->answer, "changes.json");
  command.on_run([options] { run_changes(*options); });
}

}  // namespace tools
