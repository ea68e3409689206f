#include <algorithm>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "drivers/camera/camera_list.h"
#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/commands.h"

namespace tools {

namespace {

constexpr std::size_t kMostModes = 12;

nlohmann::ordered_json camera_json(const drivers::AttachedCamera& camera) {
  const auto known = [](bool is_known, nlohmann::ordered_json value) {
    return is_known ? std::move(value) : nlohmann::ordered_json(nullptr);
  };
  return {{"name", camera.name},
          {"driver", camera.driver},
          {"source", camera.source},
          {"problem", known(!camera.problem.empty(), camera.problem)},
          {"modes", camera.modes},
          {"stamps", camera.stamps},
          {"locks", camera.locks},
          {"size_px", known(camera.width_px > 0, {camera.width_px, camera.height_px})},
          {"rate_hz", known(camera.rate_hz > 0, camera.rate_hz)},
          {"format", known(!camera.format.empty(), camera.format)}};
}

void print(std::size_t number, const drivers::AttachedCamera& camera, bool all_modes, const Answer& answer) {
  answer.text("{}  {}\n", number, camera.name);
  if (!camera.problem.empty()) {
    answer.text("   cannot be used now: {}\n\n", camera.problem);
    return;
  }
  const std::size_t n = all_modes ? camera.modes.size() : std::min(camera.modes.size(), kMostModes);
  for (std::size_t i = 0; i < n; ++i) answer.text("   {:10}{}\n", i == 0 ? "modes" : "", camera.modes[i]);
  if (n < camera.modes.size()) answer.text("   {:10}... and {} more (--all)\n", "", camera.modes.size() - n);
  answer.text("   {:10}{}\n", "stamps", camera.stamps);
  answer.text("   {:10}{}\n", "readout",
              "not stated by the device: 'hovermodal readout' measures it, or closure estimates it in "
              "flight");
  if (!camera.locks.empty()) answer.text("   {:10}{} are locked during a measurement\n", "controls", camera.locks);
  answer.text("   put into the configuration:\n\n     camera:\n       driver: {}\n       source: \"{}\"\n",
              camera.driver, camera.source);
  if (camera.width_px > 0) answer.text("       size: [{}, {}]\n", camera.width_px, camera.height_px);
  if (camera.rate_hz > 0) answer.text("       rate_hz: {:g}\n", camera.rate_hz);
  if (!camera.format.empty()) answer.text("       format: {}\n", camera.format);
  answer.text("\n");
}

struct CamerasOptions {
  bool all_modes = false;
  Answer answer;
};

void list(const CamerasOptions& options) {
  const Answer& answer = options.answer;
  const std::vector<drivers::AttachedCamera> cameras = drivers::list_cameras();
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const drivers::AttachedCamera& camera : cameras) json.push_back(camera_json(camera));
  answer.document(drivers::to_json_text({{"cameras", json}}).text);
  if (cameras.empty()) {
    answer.text(
        "No camera is attached, or none that this user may open (is the user in the group 'video'?).\n"
        "Without one: camera.driver file (a recording) or synthetic.\n");
    return;
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) print(i + 1, cameras[i], options.all_modes, answer);
}

}  // namespace

void add_inspect_cameras(drivers::Command& inspect) {
  drivers::Command cameras = inspect.subcommand(
      "cameras", "List the cameras attached: modes, what their time stamps mean, and the YAML to use them");
  const auto options = std::make_shared<CamerasOptions>();
  cameras.flag("--all", options->all_modes, "All modes of each");
  add_answer_options(cameras, options->answer, "the cameras");
  cameras.on_run([options] { list(*options); });
}

}  // namespace tools
