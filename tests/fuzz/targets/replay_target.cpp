#include <cmath>
#include <stdexcept>

#include "drivers/telemetry/run_record_reader.h"
#include "firmware_app/chain/state/run_head.h"
#include "firmware_app/replay/analysis.h"
#include "tests/fuzz/memory_file.h"

namespace tests::fuzz {
namespace {

// Memory and time of a spectrum grow with these values only; the configuration's own limits bound the rest.
bool is_small(const std::string& path) {
  drivers::RunRecordReader reader(path);
  const core::RunHead& head = reader.head();
  const app::RecordedConfig config(head, "fuzz", {});
  int n_frames = 0;
  core::RecordedFrame frame;
  while (n_frames <= 64 && reader.next(frame)) ++n_frames;
  return n_frames <= 64 && head.keyframe.points.size() <= 64 && config.config().regions.size() <= 4 &&
         config.config().spectrum.segment <= 64;
}

// `hovermodal replay` of a recorded run: geometry, spectra and modes of any content.
void run(Bytes bytes) {
  const MemoryFile file(bytes);
  try {
    if (!is_small(file.path())) return;
    const app::RecordsResult result = app::replay_records({file.path()}, {}, "");
    for (const core::Mode& mode : result.tracks.estimate.modes)
      require(std::isfinite(mode.frequency_hz) && std::isfinite(mode.damping_ratio), "a mode has numbers");
  } catch (const std::runtime_error& error) {
    require(*error.what() != '\0', "a refusal says why");
  } catch (const std::invalid_argument& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
}

const Registration kTarget("replay", &run);

}  // namespace
}  // namespace tests::fuzz
