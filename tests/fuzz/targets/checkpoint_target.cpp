#include <unistd.h>

#include <array>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "core/identification/mode_tracker.h"
#include "core/spectrum/time_grid.h"
#include "core/spectrum/welch_cpsd.h"
#include "drivers/storage/checkpoint_file.h"
#include "firmware_app/chain/state/run_state.h"
#include "firmware_app/service/kept_keyframe.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/small_state.h"

namespace tests::fuzz {
namespace {

// Resumes as the spectrum stage does, and adds samples.
void go_on_with_spectrum(Bytes bytes) {
  core::StateReader in(bytes);
  core::TimeGrid grid(kRate_hz);
  grid.restore(in);
  core::WelchCpsd welch(small_welch());
  const bool taken = welch.restore(in);
  for (const std::int64_t t_ns : {std::int64_t{0}, std::int64_t{40'000'000}, std::int64_t{4'000'000'000},
                                  std::numeric_limits<std::int64_t>::max(), std::int64_t{-1}})
    static_cast<void>(grid.place(t_ns));
  if (!taken) require(welch.sums().n_segments == 0, "what was refused left nothing behind");
  constexpr std::array<std::uint8_t, kChannels> kSeen{1, 1};
  for (int k = 0; k < 40; ++k) static_cast<void>(welch.push(std::array<double, kChannels>{1.0 * k, -0.5 * k}, kSeen));
  welch.flush();
  require(welch.sums().n_blocks <= welch.sums().blocks.size(), "blocks in use are there");
}

void go_on_with_modes(Bytes bytes) {
  core::StateReader in(bytes);
  core::ModeTracker tracker = small_tracker();
  if (!tracker.restore(in)) require(tracker.n_followed() == 0, "what was refused left nothing behind");
  for (int k = 0; k < 3; ++k) {
    core::ModalEstimate estimate = small_estimate(k);
    tracker.update(estimate);
  }
  require(tracker.n_followed() <= core::ModeTracker::kMaxTracks, "the modes followed are bounded");
}

void look_at_state(Bytes bytes) {
  try {
    const app::RunState state = app::run_state_of(bytes);
    const app::RunState now = small_state({}, {});
    static_cast<void>(app::why_foreign(state, now));
    go_on_with_spectrum(state.spectrum);
    go_on_with_modes(state.modes);
    const std::vector<std::uint8_t> kept = app::to_bytes(state);
    require(app::to_bytes(app::run_state_of(kept)) == kept, "written and read, it is the same");
  } catch (const std::runtime_error& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
}

// A file with a correct checksum and arbitrary content.
void look_at_keyframe(Bytes bytes) {
  static const std::filesystem::path kFolder =
      std::filesystem::temp_directory_path() / ("hovermodal_fuzz_" + std::to_string(getpid()));
  std::filesystem::create_directories(kFolder);
  const std::string path = (kFolder / "keyframe").string();
  require(drivers::write_checkpoint(path, bytes).empty(), "there is room for a file (set TMPDIR)");
  const drivers::CheckpointRead read = drivers::read_checkpoint(path);
  require(read.exists && read.refused.empty() && std::equal(bytes.begin(), bytes.end(), read.bytes.begin()),
          "written and read, it is the same");
  const core::CameraInfo camera = small_camera();
  const app::KeyframeRead keyframe = app::read_keyframe(path, kConfigHash, camera, kRegions);
  std::filesystem::remove_all(kFolder);
  require(keyframe.keyframe.has_value() != !keyframe.refused.empty(), "taken or refused");
  if (!keyframe.keyframe) return;
  for (const core::TrackPoint& point : keyframe.keyframe->points.points) {
    require(point.region < kRegions && point.u_px < camera.width_px && point.v_px < camera.height_px, "in the image");
    static_cast<void>(point.seen && point.inlier);
  }
}

// The first byte selects the kind: f a file, b the bytes of a run's state, s of its spectrum, m of its modes, k
// of a keyframe.
void run(Bytes bytes) {
  Input input(bytes);
  const std::uint8_t what = input.byte();
  const Bytes rest = input.rest();
  if (what == 'f') {
    const MemoryFile file(rest);
    const drivers::CheckpointRead read = drivers::read_checkpoint(file.path());
    require(read.exists, "the file is there");
    if (read.refused.empty()) look_at_state(read.bytes);
  }
  if (what == 'b') look_at_state(rest);
  if (what == 's') go_on_with_spectrum(rest);
  if (what == 'm') go_on_with_modes(rest);
  if (what == 'k') look_at_keyframe(rest);
}

const Registration kTarget("checkpoint", &run);

}  // namespace
}  // namespace tests::fuzz
