#include "core/simulation/render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/simulation/track_generator.h"
#include "tests/support/rendered_image.h"

namespace core::simulation {
namespace {

using test_support::Image;
using test_support::small_scene;
using test_support::still_scene;

// Maps a pixel of one image to its expected position in another.
using Warp = std::function<ImagePoint(ImagePoint)>;

// Distance of the pixels around `centre` of `a`, found in `b`, from the positions by `warp`: least squares with a
// translation.
ImagePoint misses(const Image& a, const Image& b, ImagePoint centre, const Warp& warp, int half_px) {
  const int u0 = static_cast<int>(std::lround(centre.u_px)), v0 = static_cast<int>(std::lround(centre.v_px));
  double du = 0.0, dv = 0.0;
  for (int round = 0; round < 4; ++round) {
    double guu = 0, guv = 0, gvv = 0, bu = 0, bv = 0;
    for (int v = v0 - half_px; v <= v0 + half_px; ++v) {
      for (int u = u0 - half_px; u <= u0 + half_px; ++u) {
        const double gu = (8 * (a.pixel(u + 1, v) - a.pixel(u - 1, v)) - a.pixel(u + 2, v) + a.pixel(u - 2, v)) / 12;
        const double gv = (8 * (a.pixel(u, v + 1) - a.pixel(u, v - 1)) - a.pixel(u, v + 2) + a.pixel(u, v - 2)) / 12;
        const ImagePoint there = warp({static_cast<double>(u), static_cast<double>(v)});
        const double d = a.pixel(u, v) - b.at(there.u_px + du, there.v_px + dv);
        guu += gu * gu, guv += gu * gv, gvv += gv * gv, bu += gu * d, bv += gv * d;
      }
    }
    const double det = guu * gvv - guv * guv;
    du += (gvv * bu - guv * bv) / det;
    dv += (guu * bv - guv * bu) / det;
  }
  return {du, dv};
}

TEST(Renderer, ShiftsTheImageByExactlyTheProjectedMotion) {
  const Scene scene = still_scene();
  const Image still(Renderer(scene), 0);
  for (const ImagePoint shift : {ImagePoint{0.25, 0.0}, ImagePoint{0.5, -0.4}, ImagePoint{-1.3, 0.75}}) {
    Scene moved_scene = scene;
    moved_scene.camera.cx_px += shift.u_px;
    moved_scene.camera.cy_px += shift.v_px;
    const Image moved(Renderer(moved_scene), 0);
    for (const auto& [body, region] : tracking_regions(SceneMotion(scene))) {
      const ImagePoint centre{std::round(region.u_px + region.width_px / 2),
                              std::round(region.v_px + region.height_px / 2)};
      const Warp shifted = [&](ImagePoint p) { return ImagePoint{p.u_px + shift.u_px, p.v_px + shift.v_px}; };
      const ImagePoint miss = misses(still, moved, centre, shifted, 10);
      EXPECT_NEAR(miss.u_px, 0.0, 0.005) << region.name;
      EXPECT_NEAR(miss.v_px, 0.0, 0.005) << region.name;
    }
  }
}

// Pixels and tracks are computed from the same scene independently: drift, scale change, shaking and row times
// included.
TEST(Renderer, AgreesWithTheTrackGenerator) {
  Scene scene = make_paper_scene(3, 20.0);
  const Renderer renderer(scene);
  scene.tracks.points_per_region = 6;
  const TrackGenerator tracks(scene);
  const Image first(renderer, 0);
  core::TrackFrame start, later;
  tracks.generate_true({}, start);
  double sum2 = 0.0;
  int n = 0;
  for (const std::uint64_t frame : {std::uint64_t{1}, std::uint64_t{113}, std::uint64_t{499}}) {
    const Image image(renderer, frame);
    const double t_s = static_cast<double>(frame) / scene.camera.rate_hz;
    tracks.generate_true({frame, t_s, t_s, frame, false}, later);
    for (std::size_t i = 0; i < start.points.size(); ++i) {
      const int body = tracks.regions()[start.points[i].region].body;
      const ImagePoint moved{later.points[i].u_px - start.points[i].u_px, later.points[i].v_px - start.points[i].v_px};
      // The scale also changes within the window; about the point itself the warp equals the generator's motion.
      const double growth = (tracks.motion().depth_mm(body) - tracks.motion().camera().at(0.0).z_mm) /
                            (tracks.motion().depth_mm(body) - tracks.motion().camera().at(t_s).z_mm);
      const Warp warp = [&](ImagePoint p) -> ImagePoint {
        return {p.u_px + moved.u_px + (growth - 1.0) * (p.u_px - start.points[i].u_px),
                p.v_px + moved.v_px + (growth - 1.0) * (p.v_px - start.points[i].v_px)};
      };
      const ImagePoint miss = misses(first, image, {start.points[i].u_px, start.points[i].v_px}, warp, 9);
      const std::string where =
          tracks.regions()[start.points[i].region].region.name + " frame " + std::to_string(frame);
      EXPECT_NEAR(miss.u_px, 0.0, 0.05) << where;
      EXPECT_NEAR(miss.v_px, 0.0, 0.05) << where;
      sum2 += miss.u_px * miss.u_px + miss.v_px * miss.v_px;
      n += 2;
    }
  }
  EXPECT_LT(std::sqrt(sum2 / n), 0.005);
}

TEST(Renderer, BlursLikeTheMeanOfManyInstants) {
  Scene scene = small_scene();
  scene.excitation.rms_mm = 12.0;  // three times the speed
  scene.camera.readout_s = 0.0;
  scene.camera.exposure_s = 0.02;
  const Image blurred(Renderer(scene), 0);
  scene.camera.exposure_s = 0.0;
  scene.camera.rate_hz = 2000.0;
  const Renderer sharp(scene);
  constexpr int kInstants = 40;  // intervals of 0.5 ms over 20 ms, Simpson's rule
  std::vector<double> mean(blurred.light.size());
  for (std::uint64_t i = 0; i <= kInstants; ++i) {
    const Image instant(sharp, i);
    const double weight = (i == 0 || i == kInstants ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) / (3.0 * kInstants);
    for (std::size_t p = 0; p < mean.size(); ++p) mean[p] += weight * static_cast<double>(instant.light[p]);
  }
  // Inside the plates, because an edge is no smooth function of time.
  double error2 = 0.0, blur2 = 0.0;
  const Image middle(sharp, kInstants / 2);
  for (const auto& [body, region] : tracking_regions(sharp.motion())) {
    if (body == kBackgroundBody) continue;
    for (int v = static_cast<int>(region.v_px); v < region.v_px + region.height_px; ++v) {
      for (int u = static_cast<int>(region.u_px); u < region.u_px + region.width_px; ++u) {
        const double mean_light = mean[static_cast<std::size_t>(v * blurred.width_px + u)];
        error2 += std::pow(mean_light - blurred.pixel(u, v), 2);
        blur2 += std::pow(mean_light - middle.pixel(u, v), 2);
      }
    }
  }
  EXPECT_LT(std::sqrt(error2), 0.03 * std::sqrt(blur2));
}

TEST(Renderer, CoversPlateEdgesExactly) {
  Scene scene = still_scene();
  scene.background.texture.contrast_rms = 1e-6;
  for (Plate& plate : scene.plates) plate.texture.contrast_rms = 1e-6, plate.texture.mean = 200.0;
  scene.background.texture.mean = 100.0;
  const double area_px = 7 * 300.0 * 50.0 * std::pow(scene.camera.alpha_px / 2000.0, 2);
  for (const double shift : {0.0, 0.3, 0.77}) {
    scene.camera.cx_px = 959.5 + shift;
    scene.camera.cy_px = 539.5 - shift;
    double excess = 0.0;
    for (const float light : Image(Renderer(scene), 0).light) excess += static_cast<double>(light) - 100.0;
    EXPECT_NEAR(excess / 100.0, area_px, 1e-3 * area_px / 50.0);
  }
}

TEST(Renderer, AddsWhiteNoiseOfTheDeclaredSpread) {
  Scene scene = make_paper_scene(1, 2.0);
  set_image_size(scene, 960, 540);
  for (Plate& plate : scene.plates) plate.texture.contrast_rms = 10.0;  // no grey level near black or white
  const Renderer renderer(scene);
  const Image light(renderer, 7);
  std::vector<std::uint8_t> pixels(light.light.size());
  renderer.render(7, pixels.data());
  double sum = 0.0, sum2 = 0.0, neighbours = 0.0;
  std::vector<double> noise(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    noise[i] = pixels[i] - static_cast<double>(light.light[i]);
    sum += noise[i], sum2 += noise[i] * noise[i];
    if (i >= 960) neighbours += noise[i] * (noise[i - 1] + noise[i - 960]);
  }
  const double n = static_cast<double>(pixels.size());
  EXPECT_NEAR(sum / n, 0.0, 0.02);
  EXPECT_NEAR(sum2 / n, 4.0 + 1.0 / 12.0, 0.05);
  EXPECT_NEAR(neighbours / sum2, 0.0, 0.02);
}

TEST(Renderer, DrawsNoiseThatFramesDoNotShare) {
  const Scene scene = still_scene();
  const Renderer renderer(scene);
  std::vector<std::uint8_t> a(1920 * 1080), b(a.size());
  renderer.render(1, a.data());
  renderer.render(2, b.data());
  double sum2 = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum2 += (a[i] - b[i]) * (a[i] - b[i]);
  EXPECT_NEAR(sum2 / static_cast<double>(a.size()), 2.0 * (4.0 + 1.0 / 12.0), 0.1);
}

TEST(Renderer, GivesTheSameFrameToEveryThreadInAnyOrder) {
  Scene scene = small_scene();
  const Renderer renderer(scene), twin(scene);
  std::vector<std::vector<std::uint8_t>> forward(8, std::vector<std::uint8_t>(480 * 270)), backward = forward;
  std::thread other([&] {
    auto scratch = twin.make_scratch();
    for (std::uint64_t k = 8; k-- > 0;) twin.render(k, backward[k].data(), scratch);
  });
  for (std::uint64_t k = 0; k < 8; ++k) renderer.render(k, forward[k].data());
  other.join();
  EXPECT_EQ(forward, backward);
  EXPECT_NE(forward[0], forward[1]);
}

TEST(Renderer, KeepsTheSceneWhenNoiseIsSwitchedOff) {
  Scene scene = small_scene();
  const Image noisy(Renderer(scene), 5);
  scene.camera.noise_sigma = 0.0;
  EXPECT_EQ(Image(Renderer(scene), 5).light, noisy.light);
}

TEST(Renderer, GivesADuplicateThePictureItRepeats) {
  Scene scene = small_scene();
  scene.timing.jitter_rms_s = 0.002;
  const Renderer renderer(scene);
  auto scratch = renderer.make_scratch();
  std::vector<std::uint8_t> first(480 * 270), again(first.size()), jittered(first.size());
  const double t_s = FrameTiming(scene).frame_time_s(9);
  renderer.render({9, t_s, t_s, 9, false}, first.data(), scratch);
  renderer.render({9, t_s, t_s + 0.04, 10, false}, again.data(), scratch);
  renderer.render(9, jittered.data(), scratch);  // at 9 / rate
  EXPECT_EQ(first, again);
  EXPECT_NE(first, jittered);
}

TEST(Renderer, RefusesWhatItCannotDraw) {
  Scene too_fine = make_paper_scene(1, 2.0);
  too_fine.plates[2].texture.pitch_mm = 1.0;
  EXPECT_THROW(Renderer{too_fine}, std::invalid_argument);
  Scene fine_background = make_paper_scene(1, 2.0);
  fine_background.background.texture.pitch_mm = 1.0;
  EXPECT_THROW(Renderer{fine_background}, std::invalid_argument);
  Scene oblique = still_scene();  // fine enough seen straight, too fine so obliquely
  oblique.camera.alpha_px *= 0.7;
  oblique.camera.yaw_rad = 0.9;
  oblique.camera.x_mm = -2000.0 * std::tan(0.9);
  EXPECT_THROW(Renderer{oblique}, std::invalid_argument);
}

}  // namespace
}  // namespace core::simulation
