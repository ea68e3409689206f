#include "core/simulation/render/render_textures.h"

#include <Eigen/SVD>
#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/simulation/camera/projection.h"

namespace core::simulation {
namespace {

int cells_for(double extent_mm, double pitch_mm) {
  const double cells = std::ceil(extent_mm / pitch_mm) + 8.0;
  if (cells > 8192.0) {
    throw std::invalid_argument("simulation: a texture of " + std::to_string(extent_mm) + " mm with a pitch of " +
                                std::to_string(pitch_mm) + " mm needs more than 8192 cells; give a coarser pitch");
  }
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(cells)));
}

void require_resolved(const std::string& of, double pitch_px) {
  if (!(pitch_px < 1.5)) return;
  throw std::invalid_argument("simulation: texture pitch of " + of + " is " + std::to_string(pitch_px) +
                              " px in the image; give at least 1.5 px");
}

// The smallest size of a millimetre of a plane in the image, whichever way it lies.
double least_px_per_mm(const CameraParameters& camera, const CameraPose& pose, double x_mm, double y_mm, double z_mm) {
  constexpr double kStep_mm = 0.01;
  const auto slope = [&](double dx, double dy) -> Eigen::Vector2d {
    const ImagePoint a = project(camera, pose, x_mm - dx, y_mm - dy, z_mm);
    const ImagePoint b = project(camera, pose, x_mm + dx, y_mm + dy, z_mm);
    return {(b.u_px - a.u_px) / (2.0 * kStep_mm), (b.v_px - a.v_px) / (2.0 * kStep_mm)};
  };
  Eigen::Matrix2d image;
  image << slope(kStep_mm, 0.0), slope(0.0, kStep_mm);
  return image.jacobiSvd().singularValues()(1);
}

void require_resolved(const Scene& scene, const Plate& plate) {
  const CameraParameters& camera = scene.camera;
  const CameraPose pose{camera.x_mm, camera.y_mm, camera.z_mm,
                        attitude(camera.pitch_rad, camera.yaw_rad, camera.roll_rad), 1.0};
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const double px_per_mm =
          least_px_per_mm(camera, pose, plate.x_mm + x * plate.width_mm, plate.y_mm + y * plate.height_mm, plate.z_mm);
      require_resolved("plate " + plate.name, plate.texture.pitch_mm * px_per_mm + 1e-6);
    }
  }
}

}  // namespace

Texture background_texture(const Scene& scene) {
  const CameraParameters& camera = scene.camera;
  const TextureParameters& texture = scene.background.texture;
  const double distance_mm = scene.background.depth_mm - camera.z_mm;
  require_resolved("the background", texture.pitch_mm * camera.alpha_px / distance_mm);
  const double view = std::max(camera.width_px, camera.height_px) / camera.alpha_px;
  const double extent_mm = view * distance_mm + 6.0 * std::max(scene.hover.x_rms_mm, scene.hover.y_rms_mm);
  const double half_view_mm = 0.5 * camera.height_px / camera.alpha_px * distance_mm;
  const bool has_pattern = texture.shows == TextureParameters::Shows::kLandscape;
  return {texture,    cells_for(extent_mm, texture.pitch_mm),
          scene.seed, "background_texture",
          0,          has_pattern ? landscape_pattern(half_view_mm, scene.seed) : TexturePattern{}};
}

std::vector<Texture> plate_textures(const Scene& scene) {
  std::vector<Texture> textures;
  for (const Plate& plate : scene.plates) {
    require_resolved(scene, plate);
    const double extent_mm = std::max(plate.width_mm, plate.height_mm);
    const bool has_pattern = plate.texture.shows == TextureParameters::Shows::kFacade;
    const std::size_t body = textures.size();
    textures.emplace_back(
        plate.texture, cells_for(extent_mm, plate.texture.pitch_mm), scene.seed, "plate_texture", body,
        has_pattern ? facade_pattern(plate.width_mm, plate.height_mm, scene.seed, body) : TexturePattern{});
  }
  return textures;
}

}  // namespace core::simulation
