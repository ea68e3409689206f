// hovermodal: the desktop and ground side of the service. One file per subcommand.
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>

#include "drivers/host/command_line.h"
#include "drivers/host/memory_reserve.h"
#include "drivers/storage/printable.h"
#include "firmware_app/config/config.h"
#include "tools/hovermodal/commands.h"

namespace {

struct Subcommand {
  void (*add)(drivers::Command& program);
  const char* name;
  const char* summary;  // one line of `hovermodal --help`; `hovermodal NAME --help` prints the rest
};
constexpr Subcommand kSubcommands[] = {
    {tools::add_plan, "plan", "Plan a flight: where each mode appears, how long to hover"},
    {tools::add_calibrate, "calibrate", "Calibrate a camera from images of a chessboard"},
    {tools::add_simulate, "simulate", "Simulate a shaken structure seen by a hovering camera"},
    {tools::add_identify, "identify", "Identify modes from time series of any sensor"},
    {tools::add_closeloop, "closeloop", "Residual diagnosis: find the effect that a model lacks"},
    {tools::add_replay, "replay", "Process a run record or a tracks.csv again"},
    {tools::add_report, "report", "Write the report of a run record"},
    {tools::add_batch, "batch", "Process a folder of flights and combine their results"},
    {tools::add_batch_flight, "batch-flight", ""},
    {tools::add_changes, "changes", "Test the modes of many flights for a change over time"},
    {tools::add_compare, "compare", "Compare modes with another result, displacements with a sensor"},
    {tools::add_export, "export", "Write a run as UFF, MAT, CSV or MCAP for other programs"},
    {tools::add_magnify, "magnify", "Make a mode of a run visible: the clip's frame moved by its shape"},
    {tools::add_spy, "spy", "Show modes, displacements and health live, over LCM"},
    {tools::add_inspect, "inspect", "Show stages live; list cameras; test the network for LCM"},
    {tools::add_regions, "regions", "Propose the regions of a clip"},
    {tools::add_ground, "ground", "Serve the ground page: watch a flight in a browser"},
    {tools::add_mavlink, "mavlink", "Connect an autopilot and the service (MAVLink 2)"},
    {tools::add_readout, "readout", "Estimate a camera's readout time beside a gyro"},
};

int run(int argc, char** argv) {
  drivers::CommandLine program{
      "hovermodal: natural frequencies, damping and mode shapes of a structure, seen from a hovering drone\n"
      "The companion of the service hovermodald, at the desk and on the ground. Help on one: hovermodal COMMAND "
      "--help"};
  program.require_subcommand();
  program.version(HOVERMODAL_VERSION);
  for (const Subcommand& command : kSubcommands) {
    command.add(program);
    program.summary(command.name, command.summary);
  }
  const std::optional<int> exit_code = program.parse(argc, argv);
  if (drivers::memory_reserve_is_used()) std::fprintf(stderr, "hovermodal: %s\n", drivers::kMemoryReserveUsed);
  return exit_code.value_or(0);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    drivers::keep_memory_reserve();
    return run(argc, argv);
  } catch (const tools::ChangeFound&) {
    return 3;
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "hovermodal: %s\n", drivers::printable_lines(e.what(), "  ").c_str());
    return 2;
  } catch (const app::ConfigError& e) {  // as the service
    std::fprintf(stderr, "hovermodal: %s\n", drivers::printable_lines(e.what(), "  ").c_str());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "hovermodal: %s\n", drivers::printable_lines(e.what(), "  ").c_str());
    return 1;
  }
}
