#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/simulation/camera/lens.h"
#include "core/simulation/render/render_plane.h"
#include "core/simulation/render/render_reference.h"
#include "tests/support/rendered_image.h"

namespace core::simulation {
namespace {

using core::ReadoutDirection;
using test_support::Image;
using test_support::small_scene;
using test_support::still_scene;

constexpr LensParameters kLens{LensParameters::Model::kRadialTangential, {-0.15, 0.03, 1e-3, -5e-4, 0.0}};

// Room in the view for plates that rotate and sway.
Scene roomy_scene() {
  Scene scene = small_scene();
  scene.camera.alpha_px *= 0.85;
  scene.hover.x_rms_mm = 10.0;
  scene.hover.y_rms_mm = 4.0;
  scene.camera.exposure_s = 0.01;
  return scene;
}

struct Difference {
  double rms = 0.0, worst = 0.0;
};

Difference difference(const std::vector<float>& a, const std::vector<float>& b) {
  Difference d;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double e = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    d.worst = std::max(d.worst, e);
    d.rms += e * e;
  }
  d.rms = std::sqrt(d.rms / static_cast<double>(a.size()));
  return d;
}

// Every 23rd pixel against brute force. Near an edge its 128 points resolve a step to about 1 %.
void expect_as_by_brute_force(const Scene& scene, const std::string& what) {
  const Renderer renderer(scene);
  const RenderReference reference(scene);
  const Image image(renderer, 11);
  double sum2 = 0.0;
  int n = 0, n_plates = 0;
  for (int i = 0; i < image.width_px * image.height_px; i += 23, ++n) {
    const int u = i % image.width_px, v = i / image.width_px;
    const double t_s = 11 / scene.camera.rate_hz;
    const double wanted = reference.grey(t_s, u, v, 8, 1);
    double error = image.pixel(u, v) - wanted;
    if (std::abs(error) > 0.01) error = image.pixel(u, v) - reference.grey(t_s, u, v, 12, 128);  // an edge
    EXPECT_NEAR(error, 0.0, 1.0) << what << " at " << u << ", " << v;
    sum2 += error * error;
    const PlanePoint on_plate = reference.place(3, {u * 1.0, v * 1.0}, t_s);
    if (std::abs(on_plate.x_mm) < 150.0 && std::abs(on_plate.y_mm) < 25.0) ++n_plates;
  }
  EXPECT_LT(std::sqrt(sum2 / n), 0.05) << what;
  EXPECT_GT(n_plates, 20) << what;
}

TEST(RendererGeneralWay, AFacadeBeforeALandscapeIsAsByBruteForce) {
  Scene scene = small_scene(3);
  for (Plate& plate : scene.plates) plate.texture.shows = TextureParameters::Shows::kFacade;
  scene.background.texture.shows = TextureParameters::Shows::kLandscape;
  expect_as_by_brute_force(scene, "facade");
}

TEST(RendererGeneralWay, AgreesWithTheQuickWay) {
  const Scene scene = small_scene(3);
  const Renderer quick(scene), general(scene, Renderer::Way::kGeneral);
  EXPECT_TRUE(quick.takes_quick_way());
  EXPECT_FALSE(general.takes_quick_way());
  const Difference d = difference(Image(quick, 17).light, Image(general, 17).light);
  EXPECT_LT(d.rms, 1e-3);
  EXPECT_LT(d.worst, 1e-2);
}

TEST(RendererGeneralWay, DrawsTurnedCameras) {
  for (const double roll : {0.1, std::numbers::pi / 2, -3.1}) {
    Scene scene = roomy_scene();
    scene.camera.alpha_px *= std::abs(roll) > 1.0 && std::abs(roll) < 2.0 ? 0.8 : 1.0;
    scene.camera.roll_rad = roll;
    scene.hover.pitch_rms_rad = scene.hover.roll_rms_rad = 0.002;
    scene.rotor.yaw_rms_rad = 0.0005;
    scene.camera.exposure_s = 0.002;  // a small part of a rotor's turn
    expect_as_by_brute_force(scene, "roll " + std::to_string(roll));
  }
  Scene oblique = roomy_scene();
  for (Plate& plate : oblique.plates) plate.texture.pitch_mm *= 2.0;
  oblique.camera.yaw_rad = 0.5;
  oblique.camera.pitch_rad = 0.1;
  oblique.camera.x_mm = -2000.0 * std::tan(0.5);
  oblique.camera.y_mm = 2000.0 * std::tan(0.1) / std::cos(0.5);
  expect_as_by_brute_force(oblique, "yaw and pitch");
}

TEST(RendererGeneralWay, DrawsThroughLensesAndZoom) {
  Scene scene = roomy_scene();
  scene.camera.lens = kLens;
  expect_as_by_brute_force(scene, "radial and tangential");
  scene.hover.zoom_rms = 0.003;
  scene.camera.roll_rad = -0.08;
  expect_as_by_brute_force(scene, "with zoom");
  scene.camera.lens = {LensParameters::Model::kEquidistant, {0.02, -0.01, 0.003, 0.0, 0.0}};
  expect_as_by_brute_force(scene, "equidistant");
}

TEST(RendererGeneralWay, TiltsPlatesAboutTheirCentres) {
  Scene scene = roomy_scene();
  scene.structure.tilt = -0.02 * scene.structure.displacement;
  expect_as_by_brute_force(scene, "tilt");
}

TEST(RendererGeneralWay, ReadsInEveryDirection) {
  for (const auto direction : {ReadoutDirection::kUp, ReadoutDirection::kLeft, ReadoutDirection::kRight}) {
    Scene scene = roomy_scene();
    scene.camera.readout_direction = direction;
    scene.light.flicker_depth = 0.3;
    expect_as_by_brute_force(scene, "direction " + std::to_string(static_cast<int>(direction)));
  }
}

TEST(RendererGeneralWay, PutsTheNearestPlateInFront) {
  Scene scene = roomy_scene();
  scene.plates[2].z_mm = 1900.0;  // over part of plate 3, in front of it
  scene.plates[2].y_mm = scene.plates[3].y_mm + 25.0;
  scene.plates[2].x_mm = 70.0;
  expect_as_by_brute_force(scene, "straight");
  const Difference ways =
      difference(Image(Renderer(scene), 4).light, Image(Renderer(scene, Renderer::Way::kGeneral), 4).light);
  EXPECT_LT(ways.rms, 0.01);
  scene.camera.roll_rad = 0.05;
  expect_as_by_brute_force(scene, "turned");
}

TEST(RendererGeneralWay, FlickersByLineInBothWays) {
  Scene scene = small_scene();
  const Image steady(Renderer(scene), 3);
  scene.light.flicker_depth = 0.4;
  scene.light.gain_rms = 0.05;
  const Image lit(Renderer(scene), 3), general(Renderer(scene, Renderer::Way::kGeneral), 3);
  const Light light(scene);
  const SceneMotion motion(scene);
  double least = 2.0, most = 0.0;
  for (int v = 0; v < lit.height_px; v += 9) {
    const double factor = light.factor(motion.line_time_s(3 / scene.camera.rate_hz, {0.0, v * 1.0}));
    EXPECT_NEAR(lit.pixel(200, v), factor * steady.pixel(200, v), 1e-3);
    EXPECT_NEAR(general.pixel(200, v), factor * steady.pixel(200, v), 1e-2);
    least = std::min(least, factor), most = std::max(most, factor);
  }
  EXPECT_GT(most - least, 0.4);
}

// A quarter rotation of the camera and the matching readout: the same picture, rotated.
TEST(RendererGeneralWay, TurnsThePictureWithTheCamera) {
  Scene upright = still_scene();
  upright.camera.width_px = upright.camera.height_px = 400;
  upright.camera.cx_px = upright.camera.cy_px = 199.5;
  upright.camera.alpha_px = 600.0;
  for (Plate& plate : upright.plates) plate.texture.pitch_mm = 8.0;
  upright.background.texture.pitch_mm = 40.0;
  Scene turned = upright;
  turned.camera.roll_rad = std::numbers::pi / 2;
  turned.camera.readout_direction = ReadoutDirection::kLeft;
  const Image a(Renderer(upright), 0), b(Renderer(turned), 0);
  double worst = 0.0;
  for (int v = 0; v < 400; ++v) {
    for (int u = 0; u < 400; ++u) worst = std::max(worst, std::abs(a.pixel(u, v) - b.pixel(v, 399 - u)));
  }
  EXPECT_LT(worst, 0.01);
}

TEST(RendererGeneralWay, IsMeanGreyBeyondTheHorizon) {
  Scene scene = still_scene();
  set_image_size(scene, 480, 270);
  for (Plate& plate : scene.plates) {
    plate.texture.pitch_mm *= 12.0;
    plate.height_mm = plate.width_mm = 40.0;
  }
  scene.camera.yaw_rad = 1.19;
  scene.camera.alpha_px = 300.0;
  scene.camera.x_mm = -2000.0 * std::tan(1.19);
  const Image image(Renderer(scene), 0);
  for (const float grey : image.light) ASSERT_TRUE(std::isfinite(grey));
  double sum2 = 0.0;
  for (int v = 0; v < 270; ++v) sum2 += std::pow(image.pixel(478, v) - scene.background.texture.mean, 2);
  double near2 = 0.0;
  for (int v = 0; v < 270; ++v) near2 += std::pow(image.pixel(2, v) - scene.background.texture.mean, 2);
  EXPECT_LT(std::min(sum2, near2), 1e-6);
  EXPECT_GT(std::max(sum2, near2), 270.0);
}

TEST(RayMap, InterpolatesBetweenExactRays) {
  CameraParameters camera;
  camera.width_px = 640;
  camera.height_px = 477;
  camera.alpha_px = 500.0;
  camera.cx_px = 330.0;
  camera.cy_px = 235.0;
  for (const LensParameters& lens :
       {kLens, LensParameters{LensParameters::Model::kEquidistant, {0.05, -0.02, 0.01, 0.0, 0.0}}, LensParameters{}}) {
    camera.lens = lens;
    const RayMap map(camera, 0.01);
    std::vector<double> x(640), y(640);
    double worst_px = 0.0;
    for (const double zoom : {1.0, 0.96, 1.05}) {
      const auto check = [&](int u, int v, double ray_x, double ray_y) {
        const double alpha_px = camera.alpha_px * zoom;
        const Ray exact = undistort(lens, {(u - camera.cx_px) / alpha_px, (v - camera.cy_px) / alpha_px});
        worst_px = std::max(worst_px, camera.alpha_px * std::hypot(ray_x - exact.x, ray_y - exact.y));
      };
      map.row(476, zoom, x.data(), y.data());
      for (int u = 0; u < 640; ++u) check(u, 476, x[static_cast<std::size_t>(u)], y[static_cast<std::size_t>(u)]);
      map.column(639, zoom, x.data(), y.data());
      for (int v = 0; v < 477; ++v) check(639, v, x[static_cast<std::size_t>(v)], y[static_cast<std::size_t>(v)]);
    }
    EXPECT_LT(worst_px, 1e-4);
  }
}

TEST(HalfPlaneShare, IsTheAreaOfTheCutPixel) {
  constexpr int kSide = 400;
  for (const double degrees : {0.0, 7.0, 30.0, 45.0, 100.0}) {
    const double nx = std::cos(degrees * std::numbers::pi / 180), ny = std::sin(degrees * std::numbers::pi / 180);
    for (const double distance : {-0.8, -0.55, -0.2, 0.0, 0.31, 0.52, 0.9}) {
      int inside = 0;
      for (int i = 0; i < kSide * kSide; ++i) {
        const double x = (i % kSide + 0.5) / kSide - 0.5, y = (i / kSide + 0.5) / kSide - 0.5;
        if (nx * x + ny * y + distance > 0.0) ++inside;
      }
      EXPECT_NEAR(half_plane_share(distance, nx, ny), inside / (1.0 * kSide * kSide), 2.0 / kSide);
    }
  }
}

}  // namespace
}  // namespace core::simulation
