#include "firmware_app/report/run_findings.h"

#include <filesystem>
#include <utility>

#include "drivers/storage/text_file.h"
#include "firmware_app/config/calibration.h"
#include "firmware_app/config/core_config.h"
#include "firmware_app/config/structure_scale.h"
#include "firmware_app/report/axis_findings.h"
#include "firmware_app/report/modal_json.h"

namespace app {

PictureInputs picture_inputs(const AppConfig& config, const core::CameraInfo& camera,
                             const std::vector<core::ChannelInfo>& channels) {
  PictureInputs inputs;
  inputs.regions = config.regions;
  inputs.channels = channels;
  inputs.unit = structure_scale(config, camera_model(config, camera)).known ? "mm" : "px";
  inputs.max_frequency_hz = identifier_config(config, channels, camera.rate_hz).max_frequency_hz;
  compare_with(inputs, config.report.compare);
  return inputs;
}

void compare_with(PictureInputs& inputs, const std::string& path) {
  if (path.empty()) return;
  inputs.former_name = path;
  try {
    inputs.former = std::make_shared<const ModalReport>(read_modal_json(path));
  } catch (const drivers::FileError& error) {
    inputs.former_fault = error.what();
  }
}

RunFacts run_facts(const AppConfig& config, const core::CameraInfo& camera, const std::string& source,
                   const core::Health& health, const core::ModalEstimate& estimate, const core::MotionAxes& axes) {
  RunFacts facts;
  const bool is_address = source.find("://") != std::string::npos;
  facts.source = is_address ? source : std::filesystem::path(source).filename().string();
  if (facts.source.empty() && config.camera.driver == drivers::CameraKind::kSynthetic)
    facts.source = "synthetic camera";
  facts.method = to_text(config.method);
  facts.title = config.report.title, facts.notes = config.report.notes;
  facts.corrections = corrections(config, camera);
  facts.corrections.insert(facts.corrections.end(), estimate.amendments.begin(), estimate.amendments.end());
  facts.caveats = caveats(config, camera);
  for (std::string& words : motion_across_words(config.regions, axes)) facts.caveats.push_back(std::move(words));
  facts.health = health;
  facts.image_width_px = camera.width_px, facts.image_height_px = camera.height_px;
  return facts;
}

}  // namespace app
