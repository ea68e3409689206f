#include "tools/hovermodal/closeloop/closeloop_turning.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/observation/gyro_rotation_level.h"
#include "drivers/storage/json.h"
#include "firmware_app/report/closure_json.h"
#include "tools/hovermodal/closeloop/words.h"

namespace tools {
namespace {

constexpr std::size_t kSurrogates = 8;  // each requires a fit; evaluated by a Gumbel distribution

}  // namespace

void close_turning(const LoopRequest& request, const GyroClipOptions& options) {
  if (options.stamps.empty() || options.gyro.empty()) throw std::invalid_argument("--clip needs --stamps and --gyro");
  GyroClip clip = read_gyro_clip(options);
  core::closure::GyroRotationLevel level(std::move(clip.motion.pairs), std::move(clip.gyro), clip.config);
  core::closure::ClosureOptions loop;
  loop.n_surrogates = kSurrogates;
  loop.seed = request.seed;
  const core::closure::ClosureResult result = [&] {
    const ProgressLine line(request.answer);
    loop.progress = line.teller();
    return core::closure::close_loop(level, loop);
  }();
  request.answer.document(app::closure_json(result));
  request.answer.text("{}", closure_text(result));
  if (result.reference_error_before && result.reference_error_after) {
    request.answer.text(
        "rotation of the image beyond the model, held-out frames: {:.4f} -> {:.4f} deg rms per "
        "frame\n",
        *result.reference_error_before, *result.reference_error_after);
  }
  if (request.report.empty()) return;
  const auto path = (std::filesystem::path(request.report) / "closure.json").string();
  drivers::write_file_atomically(path, app::closure_json(result));
  request.answer.text("{} written\n", path);
}

}  // namespace tools
