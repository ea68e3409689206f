// Tables of the checks of the renderer.
#include <fmt/format.h>

#include "tools/validate/render.h"

namespace tools {

void print_klt_errors(std::uint64_t seed, int n_frames) {
  fmt::print(
      "# OpenCV's KLT in drawn frames less the true tracks: worst, rms per axis; rms of the motion; points, lost\n");
  for (const TrackError& error : check_opencv_tracks(seed, n_frames)) {
    fmt::print("klt\t{}\t{:.4f} px\t{:.4f} px\t{:.2f} px\t{}\t{}\n", error.name, error.worst_px, error.rms_px,
               error.truth_rms_px, error.n_tracks, error.n_lost);
  }
}

void print_render_speed(std::uint64_t seed, int n_threads) {
  fmt::print("# frames of 1080p per second on {} threads\n", n_threads);
  for (const RenderSpeed& speed : check_render_speed(seed, n_threads)) {
    fmt::print("speed\t{}\t{:.1f}\n", speed.name, speed.frames_per_s);
  }
}

}  // namespace tools
