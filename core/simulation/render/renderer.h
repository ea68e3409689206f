#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/camera/frame_timing.h"
#include "core/simulation/camera/light.h"
#include "core/simulation/render/render_line.h"
#include "core/simulation/render/render_plane.h"
#include "core/simulation/render/render_rays.h"
#include "core/simulation/render/render_sensor.h"
#include "core/simulation/render/texture.h"
#include "core/simulation/scene_motion.h"

namespace core::simulation {

// Draws the scene as a rolling-shutter sensor sees it, line by line (a line is a row or, if the readout runs left or
// right, a column; SceneMotion::line_time_s gives the time). Textures are evaluated exactly at each pixel's ray; plates
// cover shares of pixels, the nearest in front; then light per line, white noise and rounding to 8 bits.
// Motion blur is the mean of two instants (Gauss-Legendre) of the exposure. With h half the motion within it, the error
// of a texture wave of k rad/px is (k h)^4 / 270 of its amplitude, that of an edge's coverage at most 0.023 of the
// motion in px. Motion must be smooth within the exposure T: error (pi f T)^4 / 135 of the amplitude for a vibration
// of f Hz (1.5 % at f T = 0.38). Behind an edge the background is its mean over the exposure. A frame is a function of
// (scene, number, time) alone; any number of threads may render at once.
class Renderer {
 public:
  // A camera that looks straight along Z without a lens, at bodies that do not rotate, is drawn by a faster algorithm.
  enum class Way : std::uint8_t { kQuickest, kGeneral };
  // Throws std::invalid_argument for a scene it cannot draw.
  explicit Renderer(const Scene& scene, Way way = Way::kQuickest);

  using Scratch = RenderLine;  // working memory of one caller; built once, reused for every frame
  [[nodiscard]] Scratch make_scratch() const;

  // pixels: height x width, row-major, no padding. The noise depends on frame.number: a picture delivered twice is
  // bit-identical.
  void render(const DeliveredFrame& frame, std::uint8_t* pixels, Scratch& scratch) const;
  // Frame `number` of a sensor without jitter.
  void render(std::uint64_t number, std::uint8_t* pixels, Scratch& scratch) const;
  void render(std::uint64_t number, std::uint8_t* pixels) const;
  // The same without noise and without rounding, in grey levels. t_frame_s: start of exposure of line 0.
  void render_light(double t_frame_s, float* light) const;
  void render_light(std::uint64_t number, float* light) const;

  [[nodiscard]] const Scene& scene() const noexcept { return motion_.scene(); }
  [[nodiscard]] const SceneMotion& motion() const noexcept { return motion_; }
  [[nodiscard]] bool takes_quick_way() const noexcept { return quick_; }

 private:
  // One instant of a line's exposure.
  struct Instant {
    double t_s;
    CameraPose pose;
  };
  [[nodiscard]] int n_lines() const noexcept;
  [[nodiscard]] int line_length() const noexcept;
  [[nodiscard]] Instant instant_at(double t_s) const noexcept { return {t_s, motion_.camera().at(t_s)}; }
  [[nodiscard]] DeliveredFrame undisturbed(std::uint64_t number) const noexcept;

  void draw_line(double t_frame_s, int index, RenderLine& line) const noexcept;
  void draw_row(const Instant& a, const Instant& b, int v, RenderLine& line) const noexcept;
  void add_plate_row(std::size_t body, const Instant& instant, std::size_t i_instant, int v,
                     RenderLine& line) const noexcept;
  void draw_any_line(const Instant& a, const Instant& b, int index, RenderLine& line) const noexcept;
  void add_plate(std::size_t body, const Instant& instant, const LineRays& rays, std::size_t i_instant, float weight,
                 RenderLine& line) const noexcept;
  // A plate from low to high, moved by x, y in its own axes.
  struct PlatePart {
    double low_mm, high_mm, x_mm, y_mm;
  };
  void add_part(std::size_t body, const PlatePart& part, const Instant& instant, const LineRays& rays,
                std::size_t i_instant, float weight, RenderLine& line) const noexcept;

  SceneMotion motion_;
  Light light_;
  RayMap rays_;
  RenderSensor sensor_;
  Texture background_;
  std::vector<Texture> plate_;              // by body
  std::vector<std::size_t> front_to_back_;  // bodies
  bool rows_, quick_;
};

}  // namespace core::simulation
