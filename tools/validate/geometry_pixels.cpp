// The paper's experiment starting from pixels: clips are rendered and encoded, and the service processes them.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/simulation/render/renderer.h"
#include "firmware_app/replay/analysis.h"
#include "firmware_app/service/pipeline.h"
#include "tools/hovermodal/simulate/clip.h"
#include "tools/hovermodal/simulate/config.h"
#include "tools/validate/geometry.h"
#include "tools/validate/geometry_score.h"
#include "tools/validate/geometry_sensors.h"

namespace tools {
namespace {

namespace fs = std::filesystem;
constexpr int kQuality = 20;  // as `simulate` encodes

const std::vector<Way> kWays{{"paper", {"method=paper"}}, {"ours"}};

void run_service(const app::AppConfig& config) {
  app::Pipeline pipeline(config);
  pipeline.start();
  while (pipeline.running()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const auto outcome = pipeline.join();
  if (!outcome.fault.empty()) throw std::runtime_error("the service failed: " + outcome.fault);
}

// The service writes the tracks; each way is a replay of them.
std::vector<RecordScore> score_clip(std::uint64_t seed, const GeometryOptions& options) {
  FlightSetup setup = paper_flight();
  setup.configuration.emplace_back("spectrum.segment=512");
  setup.configuration.emplace_back("closure.adopt=off");  // reports change no mode, and take seconds each
  if (options.is_drawn) setup.drawn = DrawnFlight{.segment_s = 512.0 / 25.0};
  SimulateJob job = flight_job(setup, seed, 60.0, options);
  job.depth = Depth::kPixels;
  const core::simulation::SceneMotion motion(job.scene());
  const fs::path folder = fs::path(options.report) / fmt::format("{}clip_{}", options.is_drawn ? "drawn_" : "", seed);
  fs::create_directories(folder);
  const std::string clip = (folder / "clip.mp4").string();
  write_clip(core::simulation::Renderer(job.scene()), clip, kQuality, options.n_threads);

  const auto config = [&](const std::vector<std::string>& more) {
    std::vector<std::string> overrides = configuration_of(job, setup);
    overrides.insert(overrides.end(), more.begin(), more.end());
    return app::parse_config(config_text(job, motion, fs::absolute(clip).string()), "clip", overrides);
  };
  run_service(config({"telemetry.lcm_url=", "report.directory=" + folder.string()}));
  fs::remove(clip);  // some 130 MB
  const auto truth = shaken_modes(job.scene());
  std::vector<RecordScore> scores;
  for (const Way& way : kWays) {
    const app::TracksResult result = app::replay_tracks(config(way.overrides), (folder / "tracks.csv").string(), "");
    const Analysed analysed{result.estimate, true_estimate(job, setup, result.n_differences), result.channels, {}};
    scores.push_back(score(analysed, truth, job.scene().duration_s));
  }
  fs::remove(folder / "tracks.csv");
  return scores;
}

}  // namespace

void print_geometry_pixels(const GeometryOptions& options) {
  if (options.report.empty()) throw std::invalid_argument("--report is missing: name a folder for clips and reports");
  const std::string figure = options.is_drawn ? "geometry-pixels-drawn" : "geometry-pixels";
  print_score_columns(figure, "modes 1-3");
  CaseScores by_way(kWays.size());
  for (int i = 0; i < options.n_seeds; ++i) {
    const auto scores = score_clip(static_cast<std::uint64_t>(options.first_seed + i), options);
    for (std::size_t w = 0; w < scores.size(); ++w) by_way[w].push_back(scores[w]);
  }
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    print_scores(figure, "paper-60s", kWays[w].name, by_way[w], 3);
  }
}

}  // namespace tools
