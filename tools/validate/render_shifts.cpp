#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/simulation/presets.h"
#include "core/simulation/render/render_reference.h"
#include "core/simulation/render/renderer.h"
#include "tools/validate/render.h"

namespace tools {
namespace {

using core::simulation::ImagePoint;
using core::simulation::LensParameters;
using core::simulation::PlanePoint;
using core::simulation::Renderer;
using core::simulation::RenderReference;
using core::simulation::Scene;

constexpr std::array<ImagePoint, 8> kShifts{
    {{0.0, 0.0}, {0.125, 0.0}, {0.5, 0.0}, {0.0, 0.25}, {0.0, -0.5}, {0.3, -0.4}, {-0.77, 0.61}, {2.41, 1.18}}};
constexpr double kStartFrame_s = 1.0;

// A pixel and the points of the unshifted plate that it sees during its exposure: at the five nodes of the
// Gauss-Legendre rule, exact far beyond the renderer's two.
struct Look {
  double grey;
  std::array<PlanePoint, 5> at;
};
constexpr std::array<double, 5> kNode{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                      0.9061798459386640};
constexpr std::array<double, 5> kWeight{0.1184634425280945, 0.2393143352496832, 0.2844444444444444, 0.2393143352496832,
                                        0.1184634425280945};

// Pixels that see only this plate, for all of the shifts.
std::vector<Look> looks_at(const RenderReference& reference, int body, const std::vector<float>& light) {
  constexpr double kMargin_px = 6.0;
  const auto& motion = reference.motion();
  const auto& camera = motion.scene().camera;
  const auto& plate = motion.scene().plates[static_cast<std::size_t>(body)];
  const double margin_mm = kMargin_px * plate.z_mm / camera.alpha_px;
  const ImagePoint centre = motion.see(body, {0.0, 0.0}, kStartFrame_s);
  const int u0 = static_cast<int>(centre.u_px), v0 = static_cast<int>(centre.v_px);
  std::vector<Look> looks;
  for (int v = v0 - 12; v <= v0 + 12; ++v) {
    for (int u = u0 - 30; u <= u0 + 30; ++u) {
      const ImagePoint pixel{static_cast<double>(u), static_cast<double>(v)};
      Look look{static_cast<double>(light[static_cast<std::size_t>(v * camera.width_px + u)]), {}};
      bool inside = true;
      for (std::size_t k = 0; k < kNode.size(); ++k) {
        const double t_s = motion.line_time_s(kStartFrame_s, pixel) + 0.5 * kNode[k] * camera.exposure_s;
        look.at[k] = reference.place(body, pixel, t_s);
        inside = inside && std::abs(look.at[k].x_mm) < 0.5 * plate.width_mm - margin_mm &&
                 std::abs(look.at[k].y_mm) < 0.5 * plate.height_mm - margin_mm;
      }
      if (inside) looks.push_back(look);
    }
  }
  return looks;
}

// The shift of the plate in its own axes, mm.
PlanePoint measure(const RenderReference& reference, int body, const std::vector<Look>& looks, double mm_per_px) {
  const double step_mm = 1e-3 * mm_per_px;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  const auto grey = [&](const Look& look, double x_mm, double y_mm) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kNode.size(); ++k) {
      sum += kWeight[k] * reference.texture(body, {look.at[k].x_mm - x_mm, look.at[k].y_mm - y_mm});
    }
    return sum;
  };
  for (int round = 0; round < 12; ++round) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (const Look& look : looks) {
      const double x = shift.x(), y = shift.y();
      const Eigen::Vector2d slope(grey(look, x + step_mm, y) - grey(look, x - step_mm, y),
                                  grey(look, x, y + step_mm) - grey(look, x, y - step_mm));
      normal += slope * slope.transpose() / (4.0 * step_mm * step_mm);
      right += slope / (2.0 * step_mm) * (look.grey - grey(look, x, y));
    }
    const Eigen::Vector2d change = normal.ldlt().solve(right);
    shift += change;
    if (change.norm() < 1e-8 * mm_per_px) break;
  }
  return {shift.x(), shift.y()};
}

ShiftError check(std::string name, const Scene& scene, bool smooth) {
  ShiftError error{std::move(name), 0.0, 0.0, 0, smooth};
  const RenderReference reference(scene);
  double sum2 = 0.0;
  std::vector<float> light(static_cast<std::size_t>(scene.camera.width_px * scene.camera.height_px));
  for (const ImagePoint& known : kShifts) {
    Scene moved = scene;
    const double mm_per_px = scene.plates[0].z_mm / scene.camera.alpha_px;
    for (auto& plate : moved.plates) plate.x_mm += known.u_px * mm_per_px, plate.y_mm += known.v_px * mm_per_px;
    Renderer(moved).render_light(kStartFrame_s, light.data());
    for (const int body : {0, 3, 6}) {
      const PlanePoint found = measure(reference, body, looks_at(reference, body, light), mm_per_px);
      for (const double px : {found.x_mm / mm_per_px - known.u_px, found.y_mm / mm_per_px - known.v_px}) {
        error.worst_px = std::max(error.worst_px, std::abs(px));
        sum2 += px * px;
      }
      ++error.n_shifts;
    }
  }
  error.rms_px = std::sqrt(sum2 / (2 * error.n_shifts));
  return error;
}

Scene scene_of(std::uint64_t seed, bool smooth, bool moving) {
  Scene scene = core::simulation::make_paper_scene(seed, 10.0);
  core::simulation::set_image_size(scene, 960, 540);
  scene.camera.alpha_px *= 0.93;
  for (auto& plate : scene.plates) {
    plate.height_mm = 80.0;
    plate.texture.pitch_mm = (smooth ? 2.75 : 1.6) * plate.z_mm / scene.camera.alpha_px;
  }
  scene.hover.y_rms_mm = 4.0;
  if (moving) {
    scene.camera.exposure_s = 0.02;  // about a pixel of motion
    scene.excitation.rms_mm = 10.0;
  } else {
    scene.camera.exposure_s = 0.0;
    scene.excitation.rms_mm = 0.0;
    scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  }
  return scene;
}

}  // namespace

std::vector<ShiftError> check_known_shifts(std::uint64_t seed) {
  std::vector<ShiftError> errors;
  for (const bool smooth : {true, false}) {
    for (const bool moving : {false, true}) {
      const std::string name = std::string(smooth ? "smooth" : "sharp") + (moving ? ", blurred" : ", still");
      Scene scene = scene_of(seed, smooth, moving);
      errors.push_back(check(name, scene, smooth));
      scene.camera.roll_rad = 5.0 * 3.14159265358979 / 180.0;
      if (!smooth) {  // the image of a turned texture stays above 1.5 px a cell
        for (auto& plate : scene.plates) plate.texture.pitch_mm *= 1.02;
      }
      errors.push_back(check(name + ", roll 5 deg", scene, smooth));
      scene.camera.lens = {LensParameters::Model::kRadialTangential, {-0.1, 0.02, 5e-4, -5e-4, 0.0}};
      errors.push_back(check(name + ", roll, lens", scene, smooth));
      scene.camera.readout_direction = core::ReadoutDirection::kLeft;
      errors.push_back(check(name + ", roll, lens, left", scene, smooth));
    }
  }
  return errors;
}

}  // namespace tools
