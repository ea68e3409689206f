#include "firmware_app/chain/state/run_head.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "drivers/storage/text_file.h"
#include "firmware_app/chain/state/keyframe_jpeg.h"
#include "firmware_app/config/config_yaml.h"
#include "firmware_app/config/region_axis.h"

namespace app {

namespace fs = std::filesystem;

namespace {

// Keys besides the files that the configuration names.
constexpr const char *kKeyframeKey = "keyframe", *kStateKey = "state";

std::string make_folder() {
  std::string form = (fs::temp_directory_path() / "hovermodal_XXXXXX").string();
  if (mkdtemp(form.data()) == nullptr)
    throw std::runtime_error("no folder can be made in " + fs::temp_directory_path().string() + ": set TMPDIR");
  return form;
}

}  // namespace

core::RunHead run_head(const AppConfig& config, const core::CameraInfo& camera, const core::TrackFrame& keyframe,
                       const core::Frame& image, const RunState* resumed) {
  core::RunHead head{config_yaml(config), camera, keyframe, {}, resumed != nullptr};
  const auto take = [&](const char* key, const std::string& path) {
    if (path.empty()) return;
    head.files.push_back(
        {key, fs::path(path).filename().string(), drivers::read_text_file(path, core::NamedFile::kMostBytes)});
  };
  take("calibration.file", config.calibration.file);
  take("camera.attitude_file", config.camera.attitude_file);
  take("camera.motors_file", config.camera.motors_file);
  if (std::string jpeg = keyframe_jpeg(image); !jpeg.empty())
    head.files.push_back({kKeyframeKey, "keyframe.jpg", std::move(jpeg)});
  if (resumed != nullptr) {
    const std::vector<std::uint8_t> bytes = to_bytes(*resumed);
    if (bytes.size() <= core::NamedFile::kMostBytes)
      head.files.push_back({kStateKey, "hovermodal.state", std::string(bytes.begin(), bytes.end())});
  }
  return head;
}

RecordedConfig::RecordedConfig(const core::RunHead& head, const std::string& name,
                               const std::vector<std::string>& overrides)
    : recorded_camera_(head.camera) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < head.files.size(); ++i) {
    if (head.files[i].key == kKeyframeKey) {
      image_ = keyframe_of(head.files[i].bytes, head.camera);
      if (!image_) {
        spdlog::warn("{}: the keyframe's image cannot be read (damaged, or no memory): the report shows no scene",
                     name);
      }
      continue;
    }
    if (head.files[i].key == kStateKey) {
      const std::string& bytes = head.files[i].bytes;
      resumed_ = run_state_of(std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
      continue;
    }
    if (folder_.empty()) folder_ = make_folder();
    // The name is only for messages; it may contain any characters.
    const std::string path = folder_ + fmt::format("/{}_{}", i, fs::path(head.files[i].name).filename().string());
    std::ofstream(path, std::ios::binary) << head.files[i].bytes;
    all.push_back(fmt::format("{}={}", head.files[i].key, path));
  }
  recorded_ = parse_config(head.config_yaml, name, all);
  all.insert(all.end(), overrides.begin(), overrides.end());
  config_ = parse_config(head.config_yaml, name, all);
  take_u_where_sought(recorded_);
  take_axes_of(config_, recorded_.regions);
}

RecordedConfig::~RecordedConfig() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

core::CameraInfo RecordedConfig::camera() const {
  core::CameraInfo camera = recorded_camera_;
  const CameraConfig& now = config_.camera;
  if (now.rate_hz > 0.0 && now.rate_hz != recorded_.camera.rate_hz) camera.rate_hz = now.rate_hz;
  if (now.readout_ms != recorded_.camera.readout_ms || now.readout_direction != recorded_.camera.readout_direction) {
    camera.readout_ns = static_cast<std::int64_t>(std::llround(now.readout_ms * 1e6));
    camera.readout_direction = now.readout_direction;
  }
  return camera;
}

}  // namespace app
