#include "tools/hovermodal/closeloop/closeloop_turning.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/observation/gyro_rotation_level.h"
#include "tools/hovermodal/closeloop/closing.h"

namespace tools {
namespace {

constexpr std::size_t kSurrogates = 8;  // each requires a fit; evaluated by a Gumbel distribution

}  // namespace

void close_turning(const LoopRequest& request, const GyroClipOptions& options) {
  if (options.stamps.empty() || options.gyro.empty()) throw std::invalid_argument("--clip needs --stamps and --gyro");
  GyroClip clip = read_gyro_clip(options, !request.answer.tells());
  core::closure::GyroRotationLevel level(std::move(clip.motion.pairs), std::move(clip.gyro), clip.config);
  core::closure::ClosureOptions loop;
  loop.n_surrogates = kSurrogates;
  loop.seed = request.seed;
  const core::closure::ClosureResult result = close_level(request.answer, level, loop);
  std::string more;
  if (result.reference_error_before && result.reference_error_after) {
    more = fmt::format("rotation of the image beyond the model, held-out frames: {:.4f} -> {:.4f} deg rms per frame\n",
                       *result.reference_error_before, *result.reference_error_after);
  }
  keep_earlier_closure(request.report);
  show_closure(request.answer, result, more, request.report);
}

}  // namespace tools
