#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/scene_motion.h"
#include "core/simulation/texture.h"

namespace core::simulation {

// Draws the scene as a rolling-shutter sensor sees it: row v is exposed over [t + readout v / height, + exposure];
// motion blur is a two-point Gauss-Legendre mean over the exposure (exact to fourth order in the motion); textures are
// evaluated exactly where each pixel looks; plate edges cover their pixels exactly; white Gaussian noise, rounding to 8
// bits. Behind an edge the background is its mean over the exposure. A frame is a function of (scene, number) alone;
// any number of threads may render at once.
class Renderer {
 public:
  explicit Renderer(const Scene& scene);  // throws std::invalid_argument for a scene it cannot draw

  // Working memory of one caller; built once, reused for every frame.
  struct Scratch {
    std::vector<float> light, background, plate;
    std::vector<Texture::Cell> cells, other_cells;
  };

  // pixels: height x width, row-major, no padding.
  void render(std::uint64_t frame, std::uint8_t* pixels) const;
  void render(std::uint64_t frame, std::uint8_t* pixels, Scratch& scratch) const;
  // The same without noise and without rounding, in grey levels.
  void render_light(std::uint64_t frame, float* light) const;

  [[nodiscard]] const Scene& scene() const noexcept { return motion_.scene(); }
  [[nodiscard]] const SceneMotion& motion() const noexcept { return motion_; }
  [[nodiscard]] Scratch make_scratch() const;

 private:
  // Where the pixels of a row look at one instant of its exposure.
  struct Instant {
    double t_s;
    CameraPose pose;
  };

  void render_row(double t_frame_s, int v, Scratch& scratch) const noexcept;
  void draw_background(const Instant& a, const Instant& b, int v, Scratch& scratch) const noexcept;
  void add_plate(int body, const Instant& instant, int v, Scratch& scratch) const noexcept;
  void add_noise(std::uint64_t frame, int v, const float* light, std::uint8_t* pixels) const noexcept;

  SceneMotion motion_;
  Texture background_;
  std::vector<Texture> plate_;  // by body
  std::vector<float> noise_;    // Gaussian table, grey levels; every row starts at a random place in it
  std::uint64_t noise_key_;
};

}  // namespace core::simulation
