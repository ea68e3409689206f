// hovermodal regions: proposes regions on the structure's parts, from texture and motion.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/tracking/region_proposal.h"
#include "drivers/camera/camera_factory.h"
#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/pictures/parts.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/clip_source.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/named_file.h"
#include "tools/hovermodal/regions/picker.h"
#include "tools/hovermodal/regions/regions_text.h"
#include "tools/hovermodal/simulate/progress.h"
#include "tools/hovermodal/stop_signal.h"

namespace tools {
namespace {

struct Options {
  std::string clip, out, picture;
  double rate_hz = 0.0, seconds = 12.0;
  int decoder_mb = drivers::kDecoderMb;
  bool lowest_is_base = false, serve = false, force = false;
  int port = 0;
  std::size_t most = 12;
  Answer answer;
};

constexpr const char* kFooter = R"(HOW IT CHOOSES
  Every good corner of the image is tracked through the first seconds of the clip, also where it moves by far more than
  its own size. Neighbouring points that move together form a part; the group that covers most of the image, and moves
  like a rotation, translation or zoom of the camera, is the static region. A part that bends or is long is divided. The
  table begins with what moves like a structure: parts that share their motion with others (column "shared", 0 to 1),
  far above their expected noise, and of several that move alike one before the others.
  Only moving parts are found: use a part of the clip in which the structure moves. A floor and a lamp post are not
  distinguished: check the picture, delete regions that do not belong, and draw those that are missing.

BASE
  A region that moves with the ground distinguishes peaks of the ground's motion from modes: give it `role: base`. The
  image does not show which region that is; --lowest-is-base selects the lowest one, if parts are one above the other,
  nothing below it moves, and no other part moves less. Otherwise the regions are written without a base, and the
  command ends with exit code 1 and the reason.

EXAMPLE
  hovermodal regions flight.mp4 --out regions.yaml --picture regions.png
  The file is the regions: block of a configuration. With `camera: {source: flight.mp4}` in front of it, it is one:
  (echo 'camera: {source: flight.mp4}'; cat regions.yaml) > flight.yaml; hovermodald --config flight.yaml --check)";

struct Watched {
  core::CameraInfo info;
  core::Frame first;
  std::vector<core::SurveyedPoint> points;
  std::size_t n_frames = 0;
  std::size_t n_corners = 0;
};

// Throws std::runtime_error if the source is shorter than a second.
Watched watch(const Options& options) {
  drivers::CameraOptions source;
  source.source = options.clip;
  source.rate_hz = options.rate_hz;
  source.decoder_mb = options.decoder_mb;
  const auto camera = open_clip_camera(source);
  Watched out;
  out.info = camera->info();
  const auto n_pixels = static_cast<std::size_t>(out.info.width_px) * static_cast<std::size_t>(out.info.height_px);
  core::Frame frame;
  frame.pixels.resize(n_pixels);
  camera->start();
  const auto n_wanted = static_cast<std::size_t>(options.seconds * out.info.rate_hz) + 1;
  std::optional<core::RegionSurvey> survey;
  Progress progress("regions", n_wanted, "frames", options.answer.quiet);
  progress.say("regions: Ctrl-C ends the watching with what was seen so far");
  while (out.n_frames < n_wanted && stop_requested == 0) {
    const auto status = camera->capture(frame, std::chrono::milliseconds(1000));
    if (status == drivers::CaptureStatus::kTimeout) continue;
    if (status != drivers::CaptureStatus::kFrame) break;
    if (out.n_frames++ == 0) {
      out.first = frame;
      survey.emplace(core::gray_view(frame), core::RegionSurveyConfig{});
    } else {
      survey->add(core::gray_view(frame));
    }
    progress.update(out.n_frames);
  }
  const std::string fault = camera->fault();
  camera->stop();
  if (static_cast<double>(out.n_frames) < out.info.rate_hz) {
    throw std::runtime_error(fmt::format("regions: \"{}\": {} frames are too few, a second ({:.4g}) is the least{}{}",
                                         drivers::printable(options.clip), out.n_frames, out.info.rate_hz,
                                         fault.empty() ? "" : ": ", fault));
  }
  out.n_corners = survey->n_corners();
  out.points = survey->take_points();
  return out;
}

void write_picture(const Options& options, const Watched& watched, const core::RegionProposal& proposal) {
  core::TrackFrame keyframe;
  for (const core::SurveyedPoint& point : watched.points) {
    core::TrackPoint shown;
    shown.u_px = point.at.u;
    shown.v_px = point.at.v;
    shown.seen = true;
    keyframe.points.push_back(shown);
  }
  app::PictureInputs inputs;
  inputs.first_frame = &watched.first;
  inputs.keyframe = &keyframe;
  inputs.regions = in_order(proposal);
  drivers::write_file_atomically(options.picture, app::frame_png(inputs));
}

void serve(const Options& options, const Watched& watched, const core::RegionProposal& proposal) {
  app::PictureInputs inputs;
  inputs.first_frame = &watched.first;
  run_picker(in_order(proposal), app::frame_png(inputs),
             {options.out, options.port, watched.info.width_px, watched.info.height_px});
}

void run_regions(const Options& options) {
  if (options.serve && options.out.empty()) {
    throw std::invalid_argument(
        "regions --serve: --out FILE is missing: where the page's Save button writes the regions");
  }
  require_free(options.out, options.force);
  require_free(options.picture, options.force);
  watch_stop_signals();
  const Watched watched = watch(options);
  core::RegionProposalConfig config;
  config.max_regions = options.most;
  core::RegionProposal proposal = core::propose_regions(watched.points, watched.info.rate_hz, watched.info.width_px,
                                                        watched.info.height_px, config);
  const std::string doubt = options.lowest_is_base ? make_lowest_base(proposal) : std::string();
  options.answer.document(proposal_json(proposal, watched.info.width_px, watched.info.height_px));
  options.answer.text("{} corners, {} followed through {} frames ({:.3g} s)\n\n", watched.n_corners,
                      watched.points.size(), watched.n_frames,
                      static_cast<double>(watched.n_frames) / watched.info.rate_hz);
  options.answer.text("{}", regions_table(proposal));
  if (!proposal.remark.empty()) options.answer.text("\n{}\n", proposal.remark);
  const std::string yaml = regions_yaml(in_order(proposal));
  if (options.out.empty()) {
    options.answer.text("\n{}", yaml);
  } else {
    drivers::write_file_atomically(options.out, yaml);
  }
  if (!options.picture.empty()) write_picture(options, watched, proposal);
  if (proposal.regions.empty()) {
    throw std::runtime_error(
        fmt::format("regions: \"{}\": no region found: {}", drivers::printable(options.clip), proposal.remark));
  }
  if (options.serve) serve(options, watched, proposal);
  if (!doubt.empty()) {
    throw std::runtime_error(
        fmt::format("regions: --lowest-is-base: {}; the regions are {} without a base: write role: base "
                    "at the right one by hand, or declare none",
                    doubt, options.out.empty() ? "printed" : "written to " + options.out));
  }
}

}  // namespace

void add_regions(drivers::Command& app) {
  drivers::Command command = app.subcommand(
      "regions", "Propose the regions of a clip: parts that have texture and move together, and a static one");
  const auto options = std::make_shared<Options>();
  command.option("clip", options->clip, "Video or folder of images, as camera.source").required();
  command.option("--out", options->out, "Write the regions: block here (YAML); without: it is printed");
  command.option("--picture", options->picture, "Draw the regions into the first frame (PNG)");
  command.option("--seconds", options->seconds, "Look at so much of the clip").range(1.0, 600.0).show_default();
  command.option("--rate-hz", options->rate_hz, "Frame rate, where the source states a wrong one").range(0.1, 100000.0);
  add_decoder_option(command, options->decoder_mb);
  command.option("--most", options->most, "At most so many parts").range(1, 60).show_default();
  command.flag("--lowest-is-base", options->lowest_is_base, "The lowest part moves with the ground: role base");
  command.flag("--serve", options->serve,
               "Then adjust them in a page, by mouse, finger or keyboard; its Save button writes --out. This "
               "computer alone can open it");
  command.option("--port", options->port, "Of the page; 0 = any that is free").range(0, 65535);
  add_force_option(command, options->force);
  add_answer_options(command, options->answer, "the regions in the order of the table");
  command.footer(kFooter);
  command.on_run([options] { run_regions(*options); });
}

}  // namespace tools
