#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types/attitude.h"
#include "core/types/frame.h"
#include "core/types/track.h"

namespace core {

// Attitude samples received since the previous frame. Samples beyond its capacity are counted.
struct AttitudeBatch {
  static constexpr std::size_t kMost = 64;
  std::array<AttitudeSample, kMost> samples{};
  std::uint32_t n = 0, n_left_out = 0;

  void clear() noexcept { n = n_left_out = 0; }
  void add(const AttitudeSample& sample) noexcept {
    if (n < kMost) {
      samples[n++] = sample;
    } else {
      ++n_left_out;
    }
  }
};

// A file named by the configuration, with its content, or a related one.
struct NamedFile {
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  std::string key;  // of the configuration, "keyframe" for the first image
  std::string name;
  std::string bytes;
};

// Head of a run record: everything that a replay needs in addition to the frames' points.
struct RunHead {
  std::string config_yaml;
  CameraInfo camera;
  TrackFrame keyframe;  // of the first frame; a later one has its points in this order
  std::vector<NamedFile> files;
  bool continues = false;  // the run resumes from the checkpoint of an earlier one
};

// One frame of a run record (a track record).
struct RecordedFrame {
  TrackFrame tracks;
  AttitudeBatch attitude;
  std::uint32_t stride = 1;  // as DisplacementSample::stride
};

// Counters of the run itself, from its last status message.
struct RunCounts {
  std::uint64_t frames_in = 0, frames_processed = 0, frames_dropped = 0, frames_missing = 0, snapshots_skipped = 0;
};

}  // namespace core
