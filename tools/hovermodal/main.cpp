// hovermodal: the desktop and ground side of the service. One file per subcommand.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "tools/hovermodal/commands.h"

int main(int argc, char** argv) {
  CLI::App app{
      "hovermodal: modes of vibration of a structure, seen from a hovering drone\n"
      "The service itself is hovermodald; these are its companions on the desk and on the ground."};
  app.require_subcommand(1);
  app.set_version_flag("--version", HOVERMODAL_VERSION);
  tools::add_plan(app);
  tools::add_calibrate(app);
  tools::add_simulate(app);
  tools::add_identify(app);
  tools::add_closeloop(app);
  tools::add_replay(app);
  tools::add_report(app);
  tools::add_batch(app);
  tools::add_batch_flight(app);
  tools::add_compare(app);
  tools::add_spy(app);
  tools::add_inspect(app);
  tools::add_regions(app);
  tools::add_ground(app);
  tools::add_readout(app);
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
