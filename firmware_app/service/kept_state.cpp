#include "firmware_app/service/kept_state.h"

#include <fmt/core.h>

#include <exception>
#include <filesystem>
#include <system_error>

#include "drivers/storage/checkpoint_file.h"
#include "firmware_app/chain/state/run_view.h"
#include "firmware_app/service/kept_keyframe.h"

namespace app {

RunState view_of(const AppConfig& config, const Source& source) {
  RunState view = run_view(config, source.info, source.channels());
  const bool is_file =
      config.camera.driver == drivers::CameraKind::kFile || config.camera.driver == drivers::CameraKind::kSynthetic;
  if (!is_file) view.boot_id = drivers::boot_id();
  return view;
}

std::string state_path(const AppConfig& config) {
  return config.state.directory.empty() ? "" : config.state.directory + "/hovermodal.state";
}

std::string keyframe_path(const AppConfig& config) {
  return config.state.directory.empty() ? "" : config.state.directory + "/hovermodal.keyframe";
}

void keep_keyframe(const AppConfig& config, const Source& source, HealthCollector& health) {
  if (!source.datum.empty()) health.warn(source.datum);
  if (source.kept) return;  // the file exists already
  std::error_code unmade;   // ignored: a failure shows in the write that follows
  std::filesystem::create_directories(config.state.directory, unmade);
  const std::string failure = write_keyframe(keyframe_path(config), config.hash, source.first_frame, source.keyframe);
  if (!failure.empty()) health.warn("the keyframe could not be kept: " + failure);
}

std::optional<RunState> resume_state(const std::string& path, const RunState& view, SpectrumAccumulator& spectra,
                                     ModeIdentification& modes, HealthCollector& health) {
  std::string refused;
  try {
    constexpr std::uint64_t kBeside = 1U << 20U;  // names, hashes, lengths
    const drivers::CheckpointRead read =
        drivers::read_checkpoint(path, spectra.state_bytes() + modes.state_bytes() + kBeside);
    if (!read.exists) return {};
    refused = read.refused;
    if (refused.empty()) {
      RunState saved = run_state_of(read.bytes);
      refused = why_foreign(saved, view);
      if (view.boot_id.empty() || saved.boot_id != view.boot_id) saved.boot_id.clear();
      if (refused.empty() && !spectra.resume(saved.spectrum, !saved.boot_id.empty()))
        refused = "its spectra do not fit";
      if (refused.empty()) {
        const bool has_modes = modes.resume(saved.modes);
        const core::CpsdSums& sums = spectra.sums();
        health.warn(fmt::format("goes on with the state in {}: {:.1f} s of record, {} segments{}", path,
                                static_cast<double>(sums.n_samples) / sums.rate_hz, sums.n_segments,
                                has_modes ? "" : "; mode tracking starts again"));
        return saved;
      }
    }
  } catch (const std::exception& e) {
    refused = e.what();
  }
  health.warn(fmt::format("the state in {} is not taken: {}; the record starts again", path, refused));
  return {};
}

}  // namespace app
