// hovermodal: the desktop and ground side of the service. One file per subcommand.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tools/hovermodal/commands.h"

namespace {

struct Command {
  void (*add)(CLI::App& app);
  const char* name;
  const char* summary;  // one line of `hovermodal --help`; `hovermodal NAME --help` prints the rest
};
constexpr Command kCommands[] = {
    {tools::add_plan, "plan", "Plan a flight: where each mode appears, how long to hover"},
    {tools::add_calibrate, "calibrate", "Calibrate a camera from images of a chessboard"},
    {tools::add_simulate, "simulate", "Simulate a shaken structure seen by a hovering camera"},
    {tools::add_identify, "identify", "Identify modes from time series of any sensor"},
    {tools::add_closeloop, "closeloop", "Residual diagnosis: find the effect that a model lacks"},
    {tools::add_replay, "replay", "Process a run record or a tracks.csv again"},
    {tools::add_report, "report", "Write the report of a run record"},
    {tools::add_batch, "batch", "Process a folder of flights and combine their results"},
    {tools::add_batch_flight, "batch-flight", ""},
    {tools::add_compare, "compare", "Compare modes with another result or with simulated truth"},
    {tools::add_spy, "spy", "Show modes, displacements and health live, over LCM"},
    {tools::add_inspect, "inspect", "Show stages live; list cameras; test the network for LCM"},
    {tools::add_regions, "regions", "Propose the regions of a clip"},
    {tools::add_ground, "ground", "Serve the ground page: watch a flight in a browser"},
    {tools::add_readout, "readout", "Estimate a camera's readout time beside a gyro"},
};

class Formatter final : public CLI::Formatter {
 public:
  std::string make_subcommand(const CLI::App* command) const override {
    const auto* known = std::find_if(std::begin(kCommands), std::end(kCommands),
                                     [&](const Command& one) { return command->get_name() == one.name; });
    const std::string description = command->get_description();
    std::ostringstream out;
    CLI::detail::format_help(
        out, command->get_display_name(true),
        known == std::end(kCommands) ? description.substr(0, description.find('\n')) : known->summary, kNameColumns);
    return out.str();
  }

 private:
  static constexpr std::size_t kNameColumns = 14;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "hovermodal: natural frequencies, damping and mode shapes of a structure, seen from a hovering drone\n"
      "The companion of the service hovermodald, at the desk and on the ground. Help on one: hovermodal COMMAND "
      "--help"};
  app.formatter(std::make_shared<Formatter>());
  app.require_subcommand(1);
  app.set_version_flag("--version", HOVERMODAL_VERSION);
  for (const Command& command : kCommands) command.add(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "hovermodal: %s\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "hovermodal: %s\n", e.what());
    return 1;
  }
  return 0;
}
