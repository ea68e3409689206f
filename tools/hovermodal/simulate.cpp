#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "core/simulation/renderer.h"
#include "core/simulation/presets.h"
#include "core/simulation/scene.h"
#include "drivers/storage/text_file.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/simulate_clip.h"
#include "tools/hovermodal/simulate_files.h"

namespace tools {
namespace {

namespace fs = std::filesystem;
using core::simulation::SceneMotion;

struct Options {
  std::string preset = "paper", size = "1080p", method = "hovermodal", folder;
  std::uint64_t seed = 1;
  double duration_s = 60.0;
  bool tracks_only = false, force = false;
  core::simulation::TrackParameters tracks;
  int crf = 20;
  int threads = 0;
};

std::pair<int, int> parse_size(const std::string& text) {
  static const std::map<std::string, std::pair<int, int>> kNamed{
      {"2160p", {3840, 2160}}, {"1440p", {2560, 1440}}, {"1080p", {1920, 1080}}, {"720p", {1280, 720}},
      {"540p", {960, 540}},    {"360p", {640, 360}},    {"270p", {480, 270}}};
  if (const auto named = kNamed.find(text); named != kNamed.end()) return named->second;
  const std::size_t cross = text.find('x');
  const auto width = drivers::parse_whole(std::string_view(text).substr(0, cross));
  const auto height =
      cross == std::string::npos ? std::nullopt : drivers::parse_whole(std::string_view(text).substr(cross + 1));
  if (!width || !height || *width < 320 || *height < 180 || *width > 8192 || *height > 8192 || *width % 2 != 0 ||
      *height % 2 != 0) {
    throw std::invalid_argument(
        fmt::format("--size {}: give 2160p, 1440p, 1080p, 720p, 540p, 360p, 270p or WIDTHxHEIGHT, both even, "
                    "320x180 to 8192x8192",
                    drivers::printable(text)));
  }
  return {static_cast<int>(*width), static_cast<int>(*height)};
}

SimulateJob make_job(const Options& options) {
  SimulateJob job;
  job.scene = core::simulation::make_paper_scene(options.seed, options.duration_s);
  const auto [width, height] = parse_size(options.size);
  core::simulation::set_image_size(job.scene, width, height);
  job.scene.tracks = options.tracks;
  core::simulation::validate(job.scene);
  job.tracks_only = options.tracks_only;
  job.crf = options.crf;
  return job;
}

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

void simulate(const Options& options) {
  const SimulateJob job = make_job(options);
  const fs::path folder = options.folder;
  make_folder(folder);
  const std::string product = (folder / job.product()).string();
  const SceneMotion motion(job.scene);
  // First, because it tells at once whether the folder can be written; and cheap enough to follow --method each time.
  write_config(folder, job, motion, options.method);
  if (!options.force && already_made(folder, job)) {
    fmt::print("{}: already made from the same parameters; --force makes it anew\n", product);
    return;
  }
  // truth.json comes last: a folder with it is a finished one.
  fs::remove(folder / "truth.json");
  write_true_displacements(folder, motion);
  if (job.tracks_only) {
    write_tracks(folder, job);
  } else {
    const int n_threads =
        options.threads > 0 ? options.threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    write_clip(core::simulation::Renderer(job.scene), product, job.crf, n_threads);
  }
  write_truth(folder, job, motion);
  fmt::print("{}: {} frames, {:.1f} MB\n", product, job.scene.n_frames(),
             static_cast<double>(fs::file_size(product)) / 1e6);
}

}  // namespace

void add_simulate(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("simulate", "Draw a shaken building as a hovering camera sees it, with its truth");
  const auto options = std::make_shared<Options>();
  command->add_option("--preset", options->preset, "Scene: paper (six storeys, 1080p at 25 fps, 2 m away)")
      ->check(CLI::IsMember({"paper"}))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Everything random follows from it")
      ->check([](const std::string& text) {  // a negative number would wrap
        return drivers::parse_unsigned(text) ? "" : "give a whole number from 0";
      })
      ->capture_default_str();
  command->add_option("--duration", options->duration_s, "Length in seconds")->capture_default_str();
  command->add_option("--size", options->size, "1080p, 720p, 270p, ... or WIDTHxHEIGHT; the view stays the same")
      ->capture_default_str();
  command->add_option("--out", options->folder, "Folder for clip.mp4 or tracks.csv, truth.json, config.yaml, ...")
      ->required();
  command->add_flag("--tracks-only", options->tracks_only, "Write tracks.csv as a perfect tracker would, draw nothing");
  command->add_option("--track-noise-px", options->tracks.noise_px, "With --tracks-only: noise per axis, px rms")
      ->capture_default_str();
  command->add_option("--track-loss", options->tracks.loss_probability, "With --tracks-only: chance of a lost point")
      ->capture_default_str();
  command->add_option("--points", options->tracks.points_per_region, "With --tracks-only: points per region")
      ->capture_default_str();
  command->add_option("--method", options->method, "Method in the written config.yaml: hovermodal or paper")
      ->check(CLI::IsMember({"hovermodal", "paper"}))
      ->capture_default_str();
  command->add_option("--crf", options->crf, "Quality of the clip, 0 (lossless) to 51; 20 gives some 130 MB a minute")
      ->check(CLI::Range(0, 51))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "Threads that draw; 0 = one per core")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  command->add_flag("--force", options->force, "Make it anew even when it is there");
  command->callback([options] { simulate(*options); });
}

}  // namespace tools
