#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>

#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/ground/serve.h"

#ifndef HOVERMODAL_WITH_GROUND
void tools::run_ground(const GroundOptions&) {
  throw std::runtime_error(
      "ground: this build has no web server. Install libcpp-httplib-dev, liblcm-dev, liblcm-bin and libglib2.0-dev and "
      "configure again with -DWITH_GROUND=ON.");
}
#endif

namespace tools {

void add_ground(CLI::App& app) {
  const auto options = std::make_shared<GroundOptions>();
  CLI::App* ground = app.add_subcommand("ground", "Watch a flight in a browser: camera, displacements, modes, health");
  ground->add_option("--url", options->url, "LCM URL to listen on; file://LOG?speed=1 plays an event log")
      ->capture_default_str();
  ground->add_option("--prefix", options->prefix, "Prefix of the LCM channels (telemetry.channel_prefix)")
      ->capture_default_str();
  ground
      ->add_option("--bind", options->bind_address,
                   "Address to serve on, in figures: 127.0.0.1 for this computer alone, 0.0.0.0 for every network it "
                   "is on; then whoever opens the page needs the access token that is printed")
      ->capture_default_str();
  ground->add_option("--port", options->port, "TCP port to serve on; 0 = any that is free")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  ground->add_option("--token", options->token,
                     "Access token, 16 to 128 letters, digits, - and _; default: none on 127.0.0.1, else a random one");
  ground->add_option("--name", options->names,
                     "Also answer to this host name, e.g. ground.local (addresses and localhost always work)");
  ground->add_option("--seconds", options->seconds, "End after this many seconds")->check(CLI::Range(0.1, 1e6));
  ground->footer(
      "Examples:\n"
      "  hovermodal ground                                  then open http://127.0.0.1:8086/\n"
      "  hovermodal ground --bind 0.0.0.0                   for a phone in the same network: open the address printed\n"
      "  hovermodal ground --url 'file://flight.lcm?speed=10'   a recorded flight (telemetry.log_file), ten times as "
      "fast\n"
      "The page only shows: nothing on it changes the flight or the service. It reads LCM messages and no files. What\n"
      "travels to a browser is not encrypted: across a network that you do not trust use a tunnel,\n"
      "  ssh -L 8086:127.0.0.1:8086 ground-station\n"
      "Camera pictures need telemetry.preview_period_s above 0 in the service's configuration.");
  ground->callback([options] { run_ground(*options); });
}

}  // namespace tools
