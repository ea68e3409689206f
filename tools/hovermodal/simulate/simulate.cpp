#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "core/simulation/render/renderer.h"
#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/simulate/clip.h"
#include "tools/hovermodal/simulate/config.h"
#include "tools/hovermodal/simulate/files.h"
#include "tools/hovermodal/simulate/truth.h"

namespace tools {
namespace {

namespace fs = std::filesystem;
using core::simulation::SceneMotion;

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    throw std::invalid_argument(fmt::format("--out {}: is a file; name a folder", folder.string()));
  }
  fs::create_directories(folder, error);
  if (error) {
    throw std::runtime_error(fmt::format("--out {}: cannot be made: {}; name a folder that may be written",
                                         folder.string(), error.message()));
  }
}

struct SimulateRun : SimulateOptions {
  Answer answer;
};

void write_product(const fs::path& folder, const SimulateJob& job, const SceneMotion& motion,
                   const SimulateRun& options) {
  if (job.depth == Depth::kChannels) return write_channels(folder, job, motion, options.answer.quiet);
  if (job.depth == Depth::kTracks) return write_tracks(folder, job, options.answer.quiet);
  const int n_threads =
      options.threads > 0 ? options.threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  write_clip(core::simulation::Renderer(job.scene()), (folder / job.product()).string(), job.crf, n_threads,
             options.answer.quiet);
}

// What was made, or found as it would be made. The folder is complete.
void tell(const SimulateRun& options, const SimulateJob& job, const std::string& product, bool is_new) {
  const std::size_t n_frames = job.scene().n_frames();
  const std::uintmax_t n_bytes = fs::file_size(product);
  options.answer.document(drivers::to_json_text({{"product", product},
                                                 {"config", (fs::path(options.folder) / "config.yaml").string()},
                                                 {"truth", (fs::path(options.folder) / "truth.json").string()},
                                                 {"frames", n_frames},
                                                 {"bytes", n_bytes},
                                                 {"already_made", !is_new}})
                              .text);
  if (is_new) {
    options.answer.text("{}: {} frames, {:.1f} MB\n", product, n_frames, static_cast<double>(n_bytes) / 1e6);
  } else {
    options.answer.text("{}: already made from the same parameters; --force makes it again\n", product);
  }
}

void simulate(const SimulateRun& options) {
  if (options.help_scene) return fmt::print("{}", drivers::scene_help());
  const SimulateJob job = make_job(options);
  if (options.print_scene) return fmt::print("{}", drivers::scene_text(job.file));
  if (options.folder.empty()) throw std::invalid_argument("--out is missing: name a folder for the product");
  const fs::path folder = options.folder;
  make_folder(folder);
  const std::string product = (folder / job.product()).string();
  const SceneMotion motion(job.scene());
  // First, because it fails at once if the folder cannot be written; and cheap enough to be rewritten for each
  // --method.
  write_config(folder, job, motion);
  if (!options.force && already_made(folder, job)) return tell(options, job, product, false);
  // truth.json is written last: a folder that contains it is complete.
  fs::remove(folder / "truth.json");
  write_true_displacements(folder, motion);
  write_product(folder, job, motion, options);
  write_truth(folder, job, motion);
  tell(options, job, product, true);
}

void add_scene_options(drivers::Command& command, SimulateOptions& options) {
  command.option("--scene", options.scene_path, "Scene file (YAML); --help-scene explains every key").type_name("FILE");
  command.option("--preset", options.preset, "Without a scene file: the scene to make (default: paper)")
      .one_of(drivers::scene_presets());
  command.option("--seed", options.seed, "Seed of all random numbers (default: the scene's, or 1)")
      .check([](const std::string& text) {  // a negative number would wrap
        return drivers::parse_unsigned(text) ? "" : "give a whole number from 0";
      });
  command.option("--duration", options.duration_s, "Length in seconds (default: the scene's, or 60)");
  command.option("--size", options.size, "1080p, 720p, 270p, ... or WIDTHxHEIGHT; the view stays the same");
  command.flag("--print-scene", options.print_scene, "Print the complete scene as a file to start from");
  command.flag("--help-scene", options.help_scene, "Every key of scene files: unit, default, range, meaning");
}

void add_product_options(drivers::Command& command, SimulateOptions& options) {
  command.option("--out", options.folder, "Folder for the product, truth.json, truth_displacements.csv, config.yaml");
  command.flag("--tracks-only", options.tracks_only, "Write tracks.csv as a perfect tracker would, draw nothing");
  command.flag("--channels-only", options.channels_only, "Write displacements.csv: motions without the camera's own");
  command.option("--track-noise-px", options.track_noise_px, "With --tracks-only: noise per axis, px rms");
  command.option("--track-loss", options.track_loss, "With --tracks-only: chance of a lost point");
  command.option("--points", options.points, "With --tracks-only: points per region");
  command.option("--method", options.method, "Method in the written config.yaml: hovermodal or paper")
      .one_of({"hovermodal", "paper"})
      .show_default();
  command.option("--crf", options.crf, "Quality of the clip, 0 (lossless) to 51; 20 gives some 130 MB a minute")
      .range(0, 51)
      .show_default();
  command.flag("--raw", options.raw, "Write the clip uncompressed, as clip.y4m: 3.1 GB a minute at 1080p and 25 fps");
  command.option("--threads", options.threads, "Threads that draw; 0 = one per core").range(0, 256).show_default();
  command.flag("--force", options.force, "Make it again even if it exists");
}

}  // namespace

void add_simulate(drivers::Command& app) {
  drivers::Command command =
      app.subcommand("simulate",
                     "Draw a shaken structure as a hovering camera sees it, with its truth\n"
                     "  hovermodal simulate --preset paper --duration 60 --out made\n"
                     "  hovermodal simulate --print-scene > scene.yaml\n"
                     "  hovermodal simulate --scene scene.yaml --channels-only --duration 3600 --out hour");
  const auto options = std::make_shared<SimulateRun>();
  add_scene_options(command, *options);
  add_product_options(command, *options);
  add_answer_options(command, options->answer, "what was made");
  command.on_run([options] { simulate(*options); });
}

}  // namespace tools
