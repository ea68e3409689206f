#include "core/simulation/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

constexpr std::size_t kNoiseTable = 1U << 19;
constexpr int kCellsPerPixel = 4;  // at most, however far the drift takes the camera

int cells_for(double extent_mm, double pitch_mm) {
  const double cells = std::ceil(extent_mm / pitch_mm) + 8.0;
  if (cells > 8192.0) {
    throw std::invalid_argument("simulation: a texture of " + std::to_string(extent_mm) + " mm with a pitch of " +
                                std::to_string(pitch_mm) + " mm needs more than 8192 cells; give a coarser pitch");
  }
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(cells)));
}

// A texture finer than a pixel cannot be drawn by looking at pixel centres, and would overrun the scratch memory.
void require_resolved(const TextureParameters& texture, double depth_mm, double alpha_px) {
  const double pitch_px = texture.pitch_mm * alpha_px / depth_mm;
  if (pitch_px < 1.5) {
    throw std::invalid_argument("simulation: texture pitch is " + std::to_string(pitch_px) +
                                " px in the image; give at least 1.5 px");
  }
}

// Wide enough for the view and its drift; the texture repeats beyond.
double background_extent_mm(const Scene& scene) {
  const double view = std::max(scene.camera.width_px, scene.camera.height_px) / scene.camera.alpha_px;
  return view * scene.background.depth_mm + 6.0 * std::max(scene.hover.x_rms_mm, scene.hover.y_rms_mm);
}

std::vector<float> noise_table(double sigma, std::uint64_t seed, int width_px) {
  RandomStream stream(seed, "sensor_noise");
  std::vector<float> table(kNoiseTable + static_cast<std::size_t>(width_px));
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = i < kNoiseTable ? static_cast<float>(sigma * stream.gaussian()) : table[i - kNoiseTable];
  }
  return table;
}

// light[u] for u in [begin, end): the row of texture cells at local position x(u) = x0 + u step, in cells.
void draw_texture_row(const Texture& texture, double y_mm, double x0, double step, int begin, int end,
                      std::vector<Texture::Cell>& cells, float* light) noexcept {
  const auto first = static_cast<std::int64_t>(std::floor(x0 + begin * step)) - 1;
  const auto last = static_cast<std::int64_t>(std::floor(x0 + (end - 1) * step)) + 1;
  texture.row(y_mm, first, last - first + 1, cells.data());
  const auto start = static_cast<float>(x0 + begin * step - static_cast<double>(first));
  const auto slope = static_cast<float>(step);
  const Texture::Cell* cell = cells.data();
  float* out = light + begin;
  for (int i = 0; i < end - begin; ++i) {
    const float x = start + static_cast<float>(i) * slope;
    const int index = static_cast<int>(x);  // x >= 1: truncation is floor
    const float s = x - static_cast<float>(index);
    const float* p = cell[index].p;
    out[i] = p[0] + s * (p[1] + s * (p[2] + s * p[3]));
  }
}

// Share of the pixel [centre - 1/2, centre + 1/2] that lies in [low, high].
double covered(double centre, double low, double high) noexcept {
  return std::clamp(std::min(high, centre + 0.5) - std::max(low, centre - 0.5), 0.0, 1.0);
}

}  // namespace

Renderer::Renderer(const Scene& scene)
    : motion_(scene),
      background_(scene.background.texture, cells_for(background_extent_mm(scene), scene.background.texture.pitch_mm),
                  scene.seed, "background_texture"),
      noise_(noise_table(scene.camera.noise_sigma, scene.seed, scene.camera.width_px)),
      noise_key_(mix64(scene.seed ^ hash_name("sensor_noise_rows"))) {
  if (scene.hover.rotates()) {
    throw std::invalid_argument("simulation: the renderer draws no camera rotation; set pitch, yaw and roll to 0");
  }
  require_resolved(scene.background.texture, scene.background.depth_mm, scene.camera.alpha_px);
  require_resolved(scene.plates.texture, scene.plates.depth_mm, scene.camera.alpha_px);
  const int cells = cells_for(std::max(scene.plates.width_mm, scene.plates.height_mm), scene.plates.texture.pitch_mm);
  for (int body = 0; body < scene.n_bodies(); ++body) {
    plate_.emplace_back(scene.plates.texture, cells, scene.seed, "plate_texture", static_cast<std::uint64_t>(body));
  }
}

Renderer::Scratch Renderer::make_scratch() const {
  const auto width = static_cast<std::size_t>(scene().camera.width_px);
  return {std::vector<float>(width), std::vector<float>(width), std::vector<float>(width),
          std::vector<Texture::Cell>(kCellsPerPixel * width + 16)};
}

void Renderer::render(std::uint64_t frame, std::uint8_t* pixels) const {
  Scratch scratch = make_scratch();
  render(frame, pixels, scratch);
}

void Renderer::render(std::uint64_t frame, std::uint8_t* pixels, Scratch& scratch) const {
  const double t_frame_s = motion_.frame_time_s(frame);
  for (int v = 0; v < scene().camera.height_px; ++v) {
    render_row(t_frame_s, v, scratch);
    add_noise(frame, v, scratch.light.data(), pixels + static_cast<std::ptrdiff_t>(v) * scene().camera.width_px);
  }
}

void Renderer::render_light(std::uint64_t frame, float* light) const {
  Scratch scratch = make_scratch();
  for (int v = 0; v < scene().camera.height_px; ++v) {
    render_row(motion_.frame_time_s(frame), v, scratch);
    std::copy(scratch.light.begin(), scratch.light.end(), light + static_cast<std::ptrdiff_t>(v) * scene().camera.width_px);
  }
}

void Renderer::render_row(double t_frame_s, int v, Scratch& scratch) const noexcept {
  const double middle_s = motion_.row_time_s(t_frame_s, v);
  const double offset_s = scene().camera.exposure_s / (2.0 * std::sqrt(3.0));
  draw_instant(middle_s - offset_s, v, scratch);
  std::swap(scratch.node, scratch.light);
  draw_instant(middle_s + offset_s, v, scratch);
  for (std::size_t u = 0; u < scratch.light.size(); ++u) scratch.light[u] = 0.5F * (scratch.light[u] + scratch.node[u]);
}

void Renderer::draw_instant(double t_s, int v, Scratch& scratch) const noexcept {
  const CameraParameters& camera = scene().camera;
  const CameraPose pose = motion_.hover().at(t_s);
  const double scale = (scene().background.depth_mm - pose.z_mm) / camera.alpha_px;  // mm per px
  const double pitch = background_.pitch_mm();
  const double y_mm = pose.y_mm + (v - camera.cy_px) * scale;
  draw_texture_row(background_, y_mm, (pose.x_mm - camera.cx_px * scale) / pitch, scale / pitch, 0, camera.width_px,
                   scratch.cells, scratch.light.data());
  for (int body = 0; body < scene().n_bodies(); ++body) draw_plate(body, t_s, pose, v, scratch);
}

void Renderer::draw_plate(int body, double t_s, const CameraPose& pose, int v, Scratch& scratch) const noexcept {
  const CameraParameters& camera = scene().camera;
  const PlateParameters& plates = scene().plates;
  const double scale = (plates.depth_mm - pose.z_mm) / camera.alpha_px;
  const double v_centre = camera.cy_px + (scene().body_y_mm(body) - pose.y_mm) / scale;
  const double half_v = 0.5 * plates.height_mm / scale;
  const double cover_v = covered(v, v_centre - half_v, v_centre + half_v);
  if (cover_v <= 0.0) return;
  const double u_centre = camera.cx_px + (motion_.structure().displacement_mm(body, t_s) - pose.x_mm) / scale;
  const double low = u_centre - 0.5 * plates.width_mm / scale, high = u_centre + 0.5 * plates.width_mm / scale;
  const int begin = static_cast<int>(std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(camera.width_px)));
  const int end = static_cast<int>(std::clamp(std::floor(high + 0.5) + 1.0, 0.0, static_cast<double>(camera.width_px)));
  if (begin >= end) return;

  const Texture& texture = plate_[static_cast<std::size_t>(body)];
  // Texture origin at the plate's centre.
  draw_texture_row(texture, (v - v_centre) * scale, -u_centre * scale / texture.pitch_mm(), scale / texture.pitch_mm(),
                   begin, end, scratch.cells, scratch.plate.data());
  for (int u = begin; u < end; ++u) {
    const auto cover = static_cast<float>(cover_v * covered(u, low, high));
    float& light = scratch.light[static_cast<std::size_t>(u)];
    light += cover * (scratch.plate[static_cast<std::size_t>(u)] - light);
  }
}

void Renderer::add_noise(std::uint64_t frame, int v, const float* light, std::uint8_t* pixels) const noexcept {
  const std::uint64_t row = mix64(noise_key_ + mix64(frame) + static_cast<std::uint64_t>(v));
  const float* noise = noise_.data() + row % kNoiseTable;
  for (int u = 0; u < scene().camera.width_px; ++u) {
    const float grey = std::min(std::max(light[u] + noise[u], 0.0F), 255.0F);
    pixels[u] = static_cast<std::uint8_t>(static_cast<int>(grey + 0.5F));
  }
}

}  // namespace core::simulation
