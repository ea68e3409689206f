#include <cmath>
#include <stdexcept>

#include "drivers/telemetry/run_record_reader.h"
#include "firmware_app/chain/state/run_head.h"
#include "tests/fuzz/memory_file.h"

namespace tests::fuzz {
namespace {

// A file of a recorded run, its configuration included.
void run(Bytes bytes) {
  const MemoryFile file(bytes);
  try {
    drivers::RunRecordReader reader(file.path());
    const core::RunHead& head = reader.head();
    require(std::isfinite(head.camera.rate_hz) && head.camera.rate_hz > 0.0, "the rate is one");
    require(!head.keyframe.points.empty(), "the keyframe has points");
    core::RecordedFrame frame;
    while (reader.next(frame)) {
      require(frame.tracks.points.size() == head.keyframe.points.size(), "points as in the keyframe");
      require(frame.attitude.n <= core::AttitudeBatch::kMost, "attitudes are bounded");
      for (const core::TrackPoint& point : frame.tracks.points)
        require(!point.seen || (std::isfinite(point.u_px) && std::isfinite(point.v_px)), "a seen point has a place");
    }
    const app::RecordedConfig config(head, "fuzz", {});
    require(!config.config().regions.empty(), "a configuration has regions");
  } catch (const std::runtime_error& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
}

const Registration kTarget("record", &run);

}  // namespace
}  // namespace tests::fuzz
