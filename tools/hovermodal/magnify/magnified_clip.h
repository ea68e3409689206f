#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/camera/camera_kind.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/magnify/modal_motion.h"

namespace tools {

struct MagnifyOptions {
  std::string run, clip, out;
  int mode = 1;
  double factor = 0.0;  // 0 = chosen
  double period_s = 2.0;
  std::optional<double> seconds;  // empty: 6 of the first frame, or the whole clip
  bool all_frames = false;
  int decoder_mb = drivers::kDecoderMb;
  int crf = 8;
  bool force = false, plain = false;
  Answer answer;
};

// What was written.
struct MagnifiedClip {
  double factor = 0.0, rate_hz = 0.0;
  std::uint64_t n_frames = 0;
};

// Draws `motion` into the first frame of the clip, or into all of them, and writes the video. Throws
// std::invalid_argument: a clip of another size than the run's, a factor with which the image would fold;
// std::runtime_error: a clip without frames, or the encoder's fault.
[[nodiscard]] MagnifiedClip draw_magnified(const ModalMotion& motion, const MagnifyOptions& options);

}  // namespace tools
