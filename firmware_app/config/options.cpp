#include "firmware_app/config/options.h"

#include <cstdio>

#include "drivers/host/command_line.h"
#include "firmware_app/config/config.h"

namespace app {

Options parse_options(int argc, char** argv) {
  drivers::CommandLine cli{
      "hovermodald: natural frequencies, damping and mode shapes of a structure, from the video of a hovering camera, "
      "in flight.\n\n"
      "  hovermodald --config flight.yaml                     run until the source ends or Ctrl-C\n"
      "  hovermodald --config flight.yaml --report out        also leave modal.json, displacements.csv, tracks.csv\n"
      "  hovermodald --config flight.yaml --check             validate configuration and source, run nothing\n"
      "  hovermodald --config clip.yaml --set camera.rate_hz=250 --set spectrum.segment=256\n\n"
      "Watch it from another terminal or the ground: hovermodal spy\n"
      "Exit codes: 0 done, 1 fault while running, 2 configuration or usage, 3 device missing, 4 real-time settings "
      "refused."};
  Options options;
  std::string report;
  bool help_config = false;
  cli.option("--config", options.config_path, "Configuration file (YAML); --help-config explains every key")
      .type_name("FILE");
  cli.option("--set", options.overrides, "Override one key, after the file; may be repeated")
      .type_name("section.key=value")
      .repeated();
  cli.option("--report", report, "Folder for modal.json, displacements.csv and tracks.csv").type_name("DIR");
  cli.flag("--check", options.check_only, "Validate the configuration and check the source, without running");
  cli.flag("--help-config", help_config, "Every key of the configuration: unit, default, range, meaning");
  cli.version("hovermodald " HOVERMODAL_VERSION);
  options.exit_code = cli.parse(argc, argv);
  if (options.exit_code) return options;
  if (help_config) {
    std::fputs(config_help().c_str(), stdout);
    options.exit_code = 0;
  } else if (options.config_path.empty()) {
    std::fputs("hovermodald: --config FILE is missing; --help shows the usage, --help-config a complete example\n",
               stderr);
    options.exit_code = 2;
  }
  if (!report.empty()) options.overrides.push_back("report.directory=" + report);
  return options;
}

}  // namespace app
