// hovermodal plan: what a flight will show, computed in advance.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "firmware_app/report/earlier_files.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/plan/options.h"
#include "tools/hovermodal/plan/words.h"

namespace tools {
namespace {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (std::filesystem::exists(folder, error) && !std::filesystem::is_directory(folder, error))
    throw std::invalid_argument(fmt::format("--out {}: is a file; name a folder", folder.string()));
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error(fmt::format("--out {}: cannot be made: {}; name a folder that may be written",
                                         folder.string(), error.message()));
  }
}

void run(const drivers::Command& command, const PlanOptions& options) {
  const core::planning::PlanInput input = plan_input(command, options);
  const core::planning::HoverPlan plan = core::planning::make_plan(input);
  if (!options.folder.empty()) {
    const std::filesystem::path folder = options.folder;
    make_folder(folder);
    app::keep_earlier(options.folder, "plan", {"plan.json", "plan.svg"});
    drivers::write_file_atomically((folder / "plan.json").string(), plan_json(input, plan));
    drivers::write_file_atomically((folder / "plan.svg").string(), plan_svg(input, plan));
  }
  options.answer.document(plan_json(input, plan));
  options.answer.text("{}", plan_text(input, plan));
  if (!options.folder.empty()) options.answer.text("\n{}/plan.svg and plan.json written\n", options.folder);
}

}  // namespace

void add_plan(drivers::Command& app) {
  drivers::Command command =
      app.subcommand("plan",
                     "Before the flight: where each mode will appear, what the camera can distinguish, how long "
                     "to hover");
  auto options = std::make_shared<PlanOptions>();
  add_plan_options(command, *options);
  command.on_run([command, options] { run(command, *options); });
}

}  // namespace tools
