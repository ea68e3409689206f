#pragma once

#include <optional>
#include <string>

#include "core/types/run_record.h"
#include "firmware_app/chain/state/run_state.h"
#include "firmware_app/config/config.h"

namespace app {

// Head of the run record. `image`: of the keyframe, for the report's pictures. `resumed`: the state from which the run
// resumed; null: it started without one. Throws drivers::FileError: a file that the configuration names cannot be
// read.
[[nodiscard]] core::RunHead run_head(const AppConfig& config, const core::CameraInfo& camera,
                                     const core::TrackFrame& keyframe, const core::Frame& image,
                                     const RunState* resumed);

// Configuration of a recorded run, with `overrides`. The files it names exist on disk as long as this object lives.
class RecordedConfig {
 public:
  // `name` identifies the record in messages. Throws ConfigError, std::runtime_error.
  RecordedConfig(const core::RunHead& head, const std::string& name, const std::vector<std::string>& overrides);
  ~RecordedConfig();
  RecordedConfig(const RecordedConfig&) = delete;
  RecordedConfig& operator=(const RecordedConfig&) = delete;

  [[nodiscard]] const AppConfig& config() const noexcept { return config_; }
  [[nodiscard]] const std::optional<core::Frame>& image() const noexcept { return image_; }  // of the keyframe
  // The state from which the run resumed, for a replay with `config`; null: the record has none, or it belongs to
  // another configuration.
  [[nodiscard]] const RunState* resumed(const AppConfig& config) const noexcept {
    return resumed_ && config.hash == recorded_.hash ? &*resumed_ : nullptr;
  }
  // The recorded camera, with the overrides' declarations.
  [[nodiscard]] core::CameraInfo camera() const;

 private:
  std::string folder_;  // of the extracted files; empty: none
  core::CameraInfo recorded_camera_;
  AppConfig recorded_, config_;
  std::optional<core::Frame> image_;
  std::optional<RunState> resumed_;
};

}  // namespace app
