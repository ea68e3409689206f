// hovermodal magnify: the first frame of a clip, or every frame, moved by an identified mode times a stated factor.
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/types/vector2.h"
#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "drivers/storage/printable.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/clip_source.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/magnify/magnified_clip.h"
#include "tools/hovermodal/named_file.h"

namespace tools {
namespace {

constexpr const char* kMagnifyHelp =
    "One mode of a run made visible: the first frame of the clip, or all of them, moved by the mode's shape times a "
    "factor\n"
    "  hovermodal magnify out --clip flight.mp4 --mode 2 --out mode2.mp4\n"
    "  hovermodal magnify out --clip flight.mp4 --mode 2 --factor 50 --out mode2.mp4\n"
    "  hovermodal magnify out --clip flight.mp4 --mode 2 --all-frames --out mode2.mp4\n"
    "RUN is the folder that --report wrote (modal.json, displacements.csv, tracks.csv). Every region moves as a whole, "
    "by\n"
    "its component of the shape times the mode's amplitude in the record times the factor; between the regions a mesh\n"
    "is interpolated; regions without a channel, and what is far from all, hold still. A region whose component is\n"
    "below two standard deviations is held still and named: its motion would be magnified noise. Without any region\n"
    "above that, or without standard deviations, nothing is written. The strip below the picture states mode and "
    "factor.\n"
    "--all-frames: the frames of the clip as they were filmed, each warped where its regions then are; the tracks tell "
    "it. The\n"
    "motion that is drawn is the same slow cycle, so that modes above half the frame rate are seen as well.";

std::string magnify_text(const ModalMotion& motion, const MagnifyOptions& options, const MagnifiedClip& made) {
  std::string text = fmt::format("mode {}: {:.4f}{} Hz\n", options.mode, motion.frequency_hz,
                                 motion.frequency_std_hz ? fmt::format(" +- {:.4f}", *motion.frequency_std_hz) : "");
  text += fmt::format("amplitude {:.4g} px where the shape is 1 (root 2 times the rms), times {:g}: {:.4g} px\n",
                      motion.amplitude_px, made.factor, made.factor * motion.amplitude_px);
  text += fmt::format("{:<20} {:>8} {:>8} {:>9} {:>8}\n", "region", "shape", "sigma", "drawn px", "sigma px");
  for (const RegionMotion& region : motion.regions) {
    if (region.is_static) continue;
    const double size = std::sqrt(std::norm(region.shape_u) + std::norm(region.shape_v));
    const double sigma = core::length(region.sigma_u, region.sigma_v), px = made.factor * motion.amplitude_px;
    text += fmt::format("{:<20} {:8.3f} {:8.3f} {:9.3f} {:8.3f}{}\n", drivers::printable(region.name), size, sigma,
                        region.held.empty() ? px * size : 0.0, px * sigma,
                        region.held.empty() ? "" : "  held still: " + region.held);
  }
  text += fmt::format("{}: {:g} s of {}, one cycle in {:g} s\n", drivers::printable(options.out),
                      static_cast<double>(made.n_frames) / made.rate_hz,
                      options.all_frames ? "the clip" : "its first frame", options.period_s);
  return text;
}

std::string magnify_json(const ModalMotion& motion, const MagnifyOptions& options, const MagnifiedClip& made) {
  nlohmann::ordered_json regions = nlohmann::ordered_json::array();
  for (const RegionMotion& region : motion.regions) {
    if (region.is_static) continue;
    const double px = region.held.empty() ? made.factor * motion.amplitude_px : 0.0;
    regions.push_back({{"name", region.name},
                       {"shape_u", {region.shape_u.real(), region.shape_u.imag()}},
                       {"shape_v", {region.shape_v.real(), region.shape_v.imag()}},
                       {"sigma_u", region.sigma_u},
                       {"sigma_v", region.sigma_v},
                       {"drawn_u_px", {px * region.shape_u.real(), px * region.shape_u.imag()}},
                       {"drawn_v_px", {px * region.shape_v.real(), px * region.shape_v.imag()}},
                       {"held", region.held}});
  }
  const nlohmann::ordered_json out{
      {"mode", options.mode},    {"frequency_hz", motion.frequency_hz}, {"amplitude_px", motion.amplitude_px},
      {"factor", made.factor},   {"period_s", options.period_s},        {"rate_hz", made.rate_hz},
      {"frames", made.n_frames}, {"all_frames", options.all_frames},    {"out", options.out},
      {"regions", regions}};
  return drivers::to_json_text(out).text;
}

void magnify(MagnifyOptions options) {
  require_free(options.out, options.force);
  const ModalMotion motion = modal_motion(options.run, options.mode);
  if (options.clip.empty()) {
    options.clip = (std::filesystem::path(options.run) / "clip.mp4").string();
    if (!std::filesystem::exists(options.clip))
      throw std::invalid_argument("--clip is needed: the video of the run (there is no " + options.clip + ")");
  }
  const MagnifiedClip made = draw_magnified(motion, options);
  options.answer.document(magnify_json(motion, options, made));
  options.answer.text("{}", magnify_text(motion, options, made));
}

}  // namespace

void add_magnify(drivers::Command& app) {
  auto options = std::make_shared<MagnifyOptions>();
  drivers::Command command = app.subcommand("magnify", kMagnifyHelp);
  command.option("run", options->run, "Folder of a run").required().type_name("RUN");
  command.option("--mode", options->mode, "Number of the mode in modal.json, from 1").show_default().type_name("N");
  command.option("--clip", options->clip, "Its video (default: clip.mp4 in the folder)").type_name("FILE");
  add_decoder_option(command, options->decoder_mb);
  command.option("--out", options->out, "Video to write").required().type_name("FILE.mp4");
  command.option("--factor", options->factor, "Factor of the motion (default: chosen and stated)").positive();
  command.option("--period-s", options->period_s, "Duration of one cycle as shown").range(0.4, 60.0).show_default();
  command
      .option("--seconds", options->seconds,
              "Duration of the video (default: 6 of the first frame; the clip's with --all-frames)")
      .range(0.1, 36000.0);
  command.flag("--all-frames", options->all_frames, "Every frame of the clip is moved, in place of the first one");
  command.option("--crf", options->crf, "Quality of the video: 0 lossless .. 51").range(0, 51).show_default();
  command.flag("--plain", options->plain, "No strip with mode and factor below the picture");
  add_force_option(command, options->force);
  add_answer_options(command, options->answer, "the result");
  command.on_run([options] { magnify(*options); });
}

}  // namespace tools
