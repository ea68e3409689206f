// hovermodal readout: estimates the readout time of a camera that is rotated by hand together with a gyro.
#include <fmt/format.h>

#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/geometry/gyro_readout.h"
#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/named_file.h"
#include "tools/hovermodal/readout/gyro_clip.h"
#include "tools/hovermodal/readout/residual_svg.h"

namespace tools {
namespace {

struct Options {
  GyroClipOptions input;
  std::string picture;
  bool force = false;
  Answer answer;
};

int lines_of(const Options& options, const ClipMotion& clip) {
  return core::reads_rows(options.input.direction) ? clip.height_px : clip.width_px;
}

std::string readout_text(const Options& options, const ClipMotion& clip, const core::GyroReadout& found) {
  std::string text;
  const auto append = [&text]<class... Args>(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
  };
  const int lines = lines_of(options, clip);
  std::size_t n_points = 0, n_held = 0;
  for (const core::FramePair& pair : clip.pairs) {
    n_points += pair.points.size();
    n_held += pair.held_out ? 1 : 0;
  }
  const auto deg = 180.0 / std::numbers::pi;
  append("readout_ms\t{:.3f}\t{:.3f}\n", 1e3 * found.readout.readout_s, 1e3 * found.readout.std_s);
  append("row_delay_us\t{:.3f}\t{:.3f}\n", 1e6 * found.readout.readout_s / lines, 1e6 * found.readout.std_s / lines);
  for (const core::ReadoutValue& half : found.halves)
    append("half_readout_ms\t{:.3f}\t{:.3f}\n", 1e3 * half.readout_s, 1e3 * half.std_s);
  append("focal_px\t{:.1f}\t{:.1f}\n", found.focal_px, found.focal_std_px);
  append("clock_offset_ms\t{:.3f}\t{:.3f}\n", 1e3 * found.offset_s, 1e3 * found.offset_std_s);
  append("gyro_bias_deg_s\t{:.3f}\t{:.3f}\t{:.3f}\n", deg * found.bias_rad_s.x(), deg * found.bias_rad_s.y(),
         deg * found.bias_rad_s.z());
  append("point_sigma_px\t{:.3f}\n", found.sigma_px);
  append("held_out_rms_px\t{:.3f}\t{:.3f}\n", found.rms_without_px, found.rms_with_px);
  append("# {} frame pairs, {} of them held out, {} points; value, standard deviation\n", clip.pairs.size(), n_held,
         n_points);
  append(
      "# held_out_rms_px: distance of points from the epipolar lines given by the gyro and a "
      "translation of the camera, with\n#   a readout of 0 and with the estimated one; everything "
      "else is fitted in both. In hovermodald: camera.readout_ms,\n#   camera.readout_sigma_ms\n");
  return text;
}

std::string readout_json(const Options& options, const ClipMotion& clip, const core::GyroReadout& found) {
  const auto with_sigma = [](double value, double sigma) {
    return nlohmann::ordered_json{{"value", value}, {"sigma", sigma}};
  };
  const double per_line = 1e6 / lines_of(options, clip), deg = 180.0 / std::numbers::pi;
  nlohmann::ordered_json halves = nlohmann::ordered_json::array();
  for (const core::ReadoutValue& half : found.halves)
    halves.push_back(with_sigma(1e3 * half.readout_s, 1e3 * half.std_s));
  const auto& bias = found.bias_rad_s;
  return drivers::to_json_text(
             {{"version", 1},
              {"readout_ms", with_sigma(1e3 * found.readout.readout_s, 1e3 * found.readout.std_s)},
              {"row_delay_us", with_sigma(per_line * found.readout.readout_s, per_line * found.readout.std_s)},
              {"half_readout_ms", halves},
              {"focal_px", with_sigma(found.focal_px, found.focal_std_px)},
              {"clock_offset_ms", with_sigma(1e3 * found.offset_s, 1e3 * found.offset_std_s)},
              {"gyro_bias_deg_s", {deg * bias.x(), deg * bias.y(), deg * bias.z()}},
              {"point_sigma_px", found.sigma_px},
              {"held_out_rms_px", {{"without_readout", found.rms_without_px}, {"with_readout", found.rms_with_px}}},
              {"frame_pairs", clip.pairs.size()}})
      .text;
}

void run(const Options& options) {
  require_free(options.picture, options.force);
  const GyroClip clip = read_gyro_clip(options.input, !options.answer.tells());
  const core::GyroReadout found = core::fit_gyro_readout(clip.motion.pairs, clip.gyro, clip.config);
  options.answer.document(readout_json(options, clip.motion, found));
  options.answer.text("{}", readout_text(options, clip.motion, found));
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
  add_force_option(command, options->force);
  add_answer_options(command, options->answer, "the readout time and what was fitted with it");
  command.on_run([options] { run(*options); });
}

}  // namespace tools
