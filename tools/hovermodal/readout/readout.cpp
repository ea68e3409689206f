// hovermodal readout: estimates the readout time of a camera that is rotated by hand together with a gyro.
#include <fmt/format.h>

#include <memory>
#include <numbers>

#include "core/geometry/gyro_readout.h"
#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/readout/gyro_clip.h"
#include "tools/hovermodal/readout/residual_svg.h"

namespace tools {
namespace {

struct Options {
  GyroClipOptions input;
  std::string picture;
};

void print(const Options& options, const ClipMotion& clip, const core::GyroReadout& found) {
  const int lines = core::reads_rows(options.input.direction) ? clip.height_px : clip.width_px;
  std::size_t n_points = 0, n_held = 0;
  for (const core::FramePair& pair : clip.pairs) {
    n_points += pair.points.size();
    n_held += pair.held_out ? 1 : 0;
  }
  const auto deg = 180.0 / std::numbers::pi;
  fmt::print("readout_ms\t{:.3f}\t{:.3f}\n", 1e3 * found.readout.readout_s, 1e3 * found.readout.std_s);
  fmt::print("row_delay_us\t{:.3f}\t{:.3f}\n", 1e6 * found.readout.readout_s / lines,
             1e6 * found.readout.std_s / lines);
  for (const core::ReadoutValue& half : found.halves)
    fmt::print("half_readout_ms\t{:.3f}\t{:.3f}\n", 1e3 * half.readout_s, 1e3 * half.std_s);
  fmt::print("focal_px\t{:.1f}\t{:.1f}\n", found.focal_px, found.focal_std_px);
  fmt::print("clock_offset_ms\t{:.3f}\t{:.3f}\n", 1e3 * found.offset_s, 1e3 * found.offset_std_s);
  fmt::print("gyro_bias_deg_s\t{:.3f}\t{:.3f}\t{:.3f}\n", deg * found.bias_rad_s.x(), deg * found.bias_rad_s.y(),
             deg * found.bias_rad_s.z());
  fmt::print("point_sigma_px\t{:.3f}\n", found.sigma_px);
  fmt::print("held_out_rms_px\t{:.3f}\t{:.3f}\n", found.rms_without_px, found.rms_with_px);
  fmt::print("# {} frame pairs, {} of them held out, {} points; value, standard deviation\n", clip.pairs.size(), n_held,
             n_points);
  fmt::print(
      "# held_out_rms_px: distance of points from the epipolar lines given by the gyro and a "
      "translation of the camera, with\n#   a readout of 0 and with the estimated one; everything "
      "else is fitted in both. In hovermodald: camera.readout_ms,\n#   camera.readout_sigma_ms\n");
}

void run(const Options& options) {
  const GyroClip clip = read_gyro_clip(options.input);
  const core::GyroReadout found = core::fit_gyro_readout(clip.motion.pairs, clip.gyro, clip.config);
  print(options, clip.motion, found);
  if (!options.picture.empty()) drivers::write_file_atomically(options.picture, residual_svg(clip.motion, found));
}

}  // namespace

void add_readout(drivers::Command& app) {
  const auto options = std::make_shared<Options>();
  drivers::Command command =
      app.subcommand("readout",
                     "Readout time of a camera that is shaken beside a gyro (a phone: shake it about "
                     "all axes for ten seconds; it may be carried or driven forward)\n"
                     "  hovermodal readout --clip frames --stamps framestamp.txt --gyro gyro.txt");
  add_gyro_clip_options(command, options->input, true);
  command.option("--picture", options->picture, "SVG of the residual per frame").type_name("FILE");
  command.on_run([options] { run(*options); });
}

}  // namespace tools
