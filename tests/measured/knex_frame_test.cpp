#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "firmware_app/service/pipeline.h"
#include "firmware_app/service/source.h"
#include "tests/support/measured_data.h"
#include "tests/support/pipeline_run.h"

namespace {

constexpr std::size_t kDots = 14;  // base row t00..t06 and the row above it
constexpr std::uint64_t kFrames = 582;

// One frame's centroids: u of t00, v of t00, u of t01, ...
using Centroids = std::array<double, 2 * kDots>;

std::vector<Centroids> read_centroids(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);  // frame,t00_x,t00_y,...
  std::vector<Centroids> frames;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    Centroids dots{};
    for (double& value : dots) {
      std::getline(cells, cell, ',');
      value = std::stod(cell);
    }
    frames.push_back(dots);
  }
  return frames;
}

app::AppConfig config_around(const Centroids& dots, const std::filesystem::path& clip) {
  std::string text = fmt::format("camera: {{source: '{}', rate_hz: 20}}\nregions:\n", clip.string());
  for (std::size_t t = 0; t < kDots; ++t) {
    text += fmt::format("  - {{name: t{:02}, rect: [{:.0f}, {:.0f}, 44, 44], role: {}, axis: both}}\n", t,
                        dots[2 * t] - 22.0, dots[2 * t + 1] - 22.0, t < 7 ? "base" : "structure");
  }
  text += "scale: {adaptive: false}\nspectrum: {segment: 64}\nidentification: {period: 1000}\n";
  return app::parse_config(text + "telemetry: {lcm_url: '', tracks_every: 1}\n", "knex");
}

// Mean step of a region's inliers since the first frame, px.
std::optional<core::Vector2> region_step(const core::TrackFrame& first, const core::TrackFrame& now,
                                         std::size_t region) {
  core::Vector2 sum;
  double count = 0.0;
  for (std::size_t i = 0; i < now.points.size(); ++i) {
    if (now.points[i].region != region || !now.points[i].inlier) continue;
    sum.u += now.points[i].u_px - first.points[i].u_px;
    sum.v += now.points[i].v_px - first.points[i].v_px;
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return core::Vector2{sum.u / count, sum.v / count};
}

// Rms distance between the steps of a region and of its dot, each dot's constant offset removed; -1: lost.
double rms_distance(const std::vector<core::TrackFrame>& tracks, const std::vector<Centroids>& dots,
                    std::size_t region) {
  double su = 0.0, sv = 0.0, squares = 0.0;
  for (const core::TrackFrame& now : tracks) {
    const auto step = region_step(tracks.front(), now, region);
    if (!step) return -1.0;
    const double du = step->u - dots.at(now.sequence)[2 * region];
    const double dv = step->v - dots.at(now.sequence)[2 * region + 1];
    const double origin_u = dots[0][2 * region];  // keeps the squares small
    const double origin_v = dots[0][2 * region + 1];
    su += du + origin_u;
    sv += dv + origin_v;
    squares += (du + origin_u) * (du + origin_u) + (dv + origin_v) * (dv + origin_v);
  }
  const auto n = static_cast<double>(tracks.size());
  return std::sqrt(squares / n - su / n * su / n - sv / n * sv / n);
}

// A model frame displaced at its roof and released, filmed from a tripod. The centroids were measured independently of
// this project.
TEST(MeasuredKnexFrame, TracksFollowTheDotsOfTheBaseAndTheRowAbove) {
  SKIP_WITHOUT_MEASURED("knex_frame_video/knex_1300x2046_gray.mp4");
  const auto folder = tests::measured_data_path() / "knex_frame_video";
  const std::vector<Centroids> dots = read_centroids(folder / "target_centroids_px.csv");
  ASSERT_EQ(dots.size(), kFrames);
  const app::AppConfig config = config_around(dots[0], folder / "knex_1300x2046_gray.mp4");
  const auto heard = std::make_shared<tests::Heard>();
  {
    app::Pipeline pipeline(config, app::open_camera(config), std::make_unique<tests::TellingPublisher>(heard));
    pipeline.start();
    ASSERT_TRUE(tests::runs_to_its_end(pipeline, std::chrono::seconds(240)));
    const auto outcome = pipeline.join();
    EXPECT_EQ(outcome.fault, "");
    EXPECT_EQ(outcome.health.frames_processed, kFrames);
    tests::expect_accounted(outcome.health);
  }
  ASSERT_EQ(heard->tracks.size(), kFrames);
  double worst_px = 0.0;
  double squares = 0.0;
  for (std::size_t t = 0; t < kDots; ++t) {
    const double rms_px = rms_distance(heard->tracks, dots, t);
    EXPECT_GE(rms_px, 0.0) << "dot " << t << " was lost";
    EXPECT_LE(rms_px, 0.3) << "dot " << t;
    worst_px = std::max(worst_px, rms_px);
    squares += rms_px * rms_px;
  }
  RecordProperty("worst_rms_px", fmt::format("{:.3f}", worst_px));
  RecordProperty("all_rms_px", fmt::format("{:.3f}", std::sqrt(squares / kDots)));
}

}  // namespace
