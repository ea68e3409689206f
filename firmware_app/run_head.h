#pragma once

#include <optional>
#include <string>

#include "core/types/run_record.h"
#include "firmware_app/config.h"
#include "firmware_app/run_state.h"

namespace app {

// What a record of this run begins with; `image`: of the keyframe, for the report's pictures; `resumed`: the state that
// the run goes on with, null where it begins anew. Throws drivers::FileError: a file that the configuration names
// cannot be read.
[[nodiscard]] core::RunHead run_head(const AppConfig& config, const core::CameraInfo& camera,
                                     const core::TrackFrame& keyframe, const core::Frame& image,
                                     const RunState* resumed);

// The configuration of a recorded run, with `overrides`. The files it names are laid out for as long as this lives.
class RecordedConfig {
 public:
  // `name` stands for the record in messages. Throws ConfigError, std::runtime_error.
  RecordedConfig(const core::RunHead& head, const std::string& name, const std::vector<std::string>& overrides);
  ~RecordedConfig();
  RecordedConfig(const RecordedConfig&) = delete;
  RecordedConfig& operator=(const RecordedConfig&) = delete;

  [[nodiscard]] const AppConfig& config() const noexcept { return config_; }
  [[nodiscard]] const std::optional<core::Frame>& image() const noexcept { return image_; }  // of the keyframe
  // The state that the run went on with, for a replay with `config`; null: there is none in the record, or it is of
  // another configuration.
  [[nodiscard]] const RunState* resumed(const AppConfig& config) const noexcept {
    return resumed_ && config.hash == recorded_.hash ? &*resumed_ : nullptr;
  }
  // The recorded camera, with what an override declares of it.
  [[nodiscard]] core::CameraInfo camera() const;

 private:
  std::string folder_;  // of the laid-out files; empty: there are none
  core::CameraInfo recorded_camera_;
  AppConfig recorded_, config_;
  std::optional<core::Frame> image_;
  std::optional<RunState> resumed_;
};

}  // namespace app
