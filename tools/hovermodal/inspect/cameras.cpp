#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <vector>

#include "drivers/camera/camera_list.h"
#include "drivers/host/command_line.h"
#include "tools/hovermodal/commands.h"

namespace tools {

namespace {

constexpr std::size_t kMostModes = 12;

void print(std::size_t number, const drivers::AttachedCamera& camera, bool all_modes) {
  fmt::print("{}  {}\n", number, camera.name);
  if (!camera.problem.empty()) {
    fmt::print("   cannot be used now: {}\n\n", camera.problem);
    return;
  }
  const std::size_t n = all_modes ? camera.modes.size() : std::min(camera.modes.size(), kMostModes);
  for (std::size_t i = 0; i < n; ++i) fmt::print("   {:10}{}\n", i == 0 ? "modes" : "", camera.modes[i]);
  if (n < camera.modes.size()) fmt::print("   {:10}... and {} more (--all)\n", "", camera.modes.size() - n);
  fmt::print("   {:10}{}\n", "stamps", camera.stamps);
  fmt::print("   {:10}{}\n", "readout",
             "not stated by the device: 'hovermodal readout' measures it, or closure estimates it in "
             "flight");
  if (!camera.locks.empty()) fmt::print("   {:10}{} are locked during a measurement\n", "controls", camera.locks);
  fmt::print("   put into the configuration:\n\n     camera:\n       driver: {}\n       source: \"{}\"\n",
             camera.driver, camera.source);
  if (camera.width_px > 0) fmt::print("       size: [{}, {}]\n", camera.width_px, camera.height_px);
  if (camera.rate_hz > 0) fmt::print("       rate_hz: {:g}\n", camera.rate_hz);
  if (!camera.format.empty()) fmt::print("       format: {}\n", camera.format);
  fmt::print("\n");
}

void list(bool all_modes) {
  const std::vector<drivers::AttachedCamera> cameras = drivers::list_cameras();
  if (cameras.empty()) {
    fmt::print(
        "No camera is attached, or none that this user may open (is the user in the group 'video'?).\n"
        "Without one: camera.driver file (a recording) or synthetic.\n");
    return;
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) print(i + 1, cameras[i], all_modes);
}

}  // namespace

void add_inspect_cameras(drivers::Command& inspect) {
  drivers::Command cameras = inspect.subcommand(
      "cameras", "List the cameras attached: modes, what their time stamps mean, and the YAML to use them");
  const auto all_modes = std::make_shared<bool>(false);
  cameras.flag("--all", *all_modes, "All modes of each");
  cameras.on_run([all_modes] { list(*all_modes); });
}

}  // namespace tools
