#include <memory>
#include <stdexcept>

#include "drivers/host/command_line.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/ground/serve.h"

#ifndef HOVERMODAL_WITH_GROUND
void tools::run_ground(const GroundOptions&) {
  throw std::runtime_error(
      "ground: this build has no web server. Install libboost-dev, liblcm-dev, liblcm-bin and libglib2.0-dev and "
      "configure again with -DWITH_GROUND=ON.");
}
#endif

namespace tools {

void add_ground(drivers::Command& app) {
  const auto options = std::make_shared<GroundOptions>();
  drivers::Command ground =
      app.subcommand("ground", "Watch a flight in a browser: camera, displacements, modes, health");
  ground.option("--url", options->url, "LCM URL to listen on; file://LOG?speed=1 plays an event log").show_default();
  ground.option("--prefix", options->prefix, "Prefix of the LCM channels (telemetry.channel_prefix)").show_default();
  ground
      .option("--bind", options->bind_address,
              "Address to serve on, in figures: 127.0.0.1 for this computer alone, 0.0.0.0 for every network it "
              "is on; then whoever opens the page needs the access token that is printed")
      .show_default();
  ground.option("--port", options->port, "TCP port to serve on; 0 = any that is free").show_default().range(0, 65535);
  ground.option("--token", options->token,
                "Access token, 16 to 128 letters, digits, - and _; default: none on 127.0.0.1, else a random one");
  ground.option("--name", options->names,
                "Also answer to this host name, e.g. ground.local (addresses and localhost always work)");
  ground.option("--seconds", options->seconds, "End after this many seconds").range(0.1, 1e6);
  ground.footer(
      "Examples:\n"
      "  hovermodal ground                                  then open http://127.0.0.1:8086/\n"
      "  hovermodal ground --bind 0.0.0.0                   for a phone in the same network: open the address printed\n"
      "  hovermodal ground --url 'file://flight.lcm?speed=10'   a recorded flight (telemetry.log_file), ten times as "
      "fast\n"
      "The page only shows: nothing on it changes the flight or the service. It reads LCM messages and no files. What\n"
      "travels to a browser is not encrypted: across a network that you do not trust use a tunnel,\n"
      "  ssh -L 8086:127.0.0.1:8086 ground-station\n"
      "Camera pictures need telemetry.preview_period_s above 0 in the service's configuration.");
  add_answer_options(ground, options->answer, "where the page is");
  ground.on_run([options] { run_ground(*options); });
}

}  // namespace tools
