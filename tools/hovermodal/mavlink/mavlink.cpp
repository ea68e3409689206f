#include <memory>

#include "drivers/host/command_line.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/mavlink/bridge.h"

namespace tools {

void add_mavlink(drivers::Command& app) {
  drivers::Command mavlink = app.subcommand(
      "mavlink",
      "Connect an autopilot and the service: attitude, motors and wind to LCM, modes to the ground station (MAVLink "
      "2)\n\n"
      "Takes the attitude of the aircraft or of its gimbal, puts it on this computer's clock (TIMESYNC) and sends it "
      "on an LCM channel; a service with camera.attitude_channel uses it. Once a second it sends the motors' speeds, "
      "position and wind on another; a service with camera.aircraft_channel states them in its report and names the "
      "motor of each rotor line. Sends a heartbeat, and the lowest modes of each estimate as NAMED_VALUE_FLOAT (f1_hz, "
      "z1_pct, ...) and STATUSTEXT, which ground stations show. It commands nothing. With --motors the speeds are kept "
      "for a later `replay` or `closeloop` with camera.motors_file.\n\n"
      "  hovermodal mavlink --link udpin:127.0.0.1:14540          a simulator, or mavlink-router on this computer\n"
      "  hovermodal mavlink --link serial:/dev/ttyAMA0:921600     a flight controller's TELEM port");
  const auto options = std::make_shared<MavlinkOptions>();
  mavlink
      .option("--link", options->link,
              "Where MAVLink comes from: udpin:ADDRESS:PORT, udpout:HOST:PORT, tcp:HOST:PORT, serial:DEVICE:BAUD")
      .required();
  mavlink.option("--url", options->url, "LCM URL to send to and to listen on").show_default();
  mavlink.option("--prefix", options->prefix, "Prefix of the service's LCM channels (telemetry.channel_prefix)")
      .show_default();
  mavlink.option("--channel", options->channel, "LCM channel of the attitude (camera.attitude_channel)").show_default();
  mavlink
      .option("--aircraft-channel", options->aircraft_channel,
              "LCM channel of motors, position and wind (camera.aircraft_channel)")
      .show_default();
  mavlink.flag("--gimbal", options->of_gimbal, "The gimbal's attitude in place of the aircraft's");
  mavlink.option("--csv", options->csv, "Write the attitudes to this file as well (camera.attitude_file)");
  mavlink.option("--motors", options->motors, "Write the motors' speeds to this file (camera.motors_file)");
  mavlink.option("--seconds", options->seconds, "End after this many seconds").range(0.1, 1e6);
  add_answer_options(mavlink, options->answer, "the counts at the end");
  mavlink.on_run([options] { run_mavlink(*options); });
}

}  // namespace tools
