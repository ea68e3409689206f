#include "core/simulation/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

constexpr std::size_t kNoiseTable = 1U << 19;
constexpr double kLargestMerge = 0.05;  // cells
constexpr int kCellsPerPixel = 4;       // at most, however far the drift takes the camera

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

// A row of pixels on a texture: pixel u looks at x(u) = x0 + u step, in cells, and at y_mm.
struct TextureRow {
  double y_mm, x0, step;
};

// The cells that pixels begin .. end - 1 look at, with one to spare on either side.
struct CellRange {
  std::int64_t first, count;
};

CellRange cells_of(const TextureRow& row, int begin, int end) noexcept {
  const auto first = static_cast<std::int64_t>(std::floor(row.x0 + begin * row.step)) - 1;
  const auto last = static_cast<std::int64_t>(std::floor(row.x0 + (end - 1) * row.step)) + 1;
  return {first, last - first + 1};
}

constexpr int kBlock = 4;  // pixels computed at once

// light[u] for u in [begin, end), cell by cell; up to kBlock - 1 pixels beyond `end` are overwritten.
void evaluate(const TextureRow& row, std::int64_t first_cell, const Texture::Cell* cells, int begin, int end,
              float* light) noexcept {
  const double pixels_per_cell = 1.0 / row.step;
  const auto slope = static_cast<float>(row.step);
  auto cell = static_cast<std::int64_t>(std::floor(row.x0 + begin * row.step));
  for (int u = begin; u < end; ++cell) {
    const float p0 = cells[cell - first_cell].p[0], p1 = cells[cell - first_cell].p[1];
    const float p2 = cells[cell - first_cell].p[2], p3 = cells[cell - first_cell].p[3];
    const double origin = row.x0 - static_cast<double>(cell);
    const int next = std::clamp(static_cast<int>(std::ceil((1.0 - origin) * pixels_per_cell)), u, end);
    for (; u < next; u += kBlock) {
      const auto start = static_cast<float>(origin + u * row.step);
      for (int k = 0; k < kBlock; ++k) {
        const float s = start + static_cast<float>(k) * slope;
        light[u + k] = p0 + s * (p1 + s * (p2 + s * p3));
      }
    }
    u = next;
  }
}

void draw_texture(const Texture& texture, const TextureRow& row, int begin, int end, std::vector<Texture::Cell>& cells,
                  float* light) noexcept {
  const CellRange range = cells_of(row, begin, end);
  texture.row(row.y_mm, range.first, range.count, cells.data());
  evaluate(row, range.first, cells.data(), begin, end, light);
}

// cell(s) becomes the mean of a(s - shift) and b(s + shift): both polynomials expanded about their shifted origins.
void mean_of_shifted(Texture::Cell& a, const Texture::Cell& b, float shift) noexcept {
  const auto expand = [](const float* p, float d, float* q) {
    q[0] = p[0] + d * (p[1] + d * (p[2] + d * p[3]));
    q[1] = p[1] + d * (2.0F * p[2] + 3.0F * d * p[3]);
    q[2] = p[2] + 3.0F * d * p[3];
    q[3] = p[3];
  };
  float before[4], after[4];
  expand(a.p, -shift, before);
  expand(b.p, shift, after);
  for (int i = 0; i < 4; ++i) a.p[i] = 0.5F * (before[i] + after[i]);
}

// Rounded to 0 .. 255. Clamped as integers and without aliasing, so that the compiler takes several pixels at a time.
void quantise(const float* __restrict light, const float* __restrict noise, int n, std::uint8_t* __restrict pixels) {
  for (int i = 0; i < n; ++i) {
    const int grey = static_cast<int>(light[i] + noise[i] + 0.5F);
    pixels[i] = static_cast<std::uint8_t>(grey < 0 ? 0 : grey > 255 ? 255 : grey);
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
  if (motion_.camera().rotates() || motion_.camera().zooms() || motion_.structure().tilts() ||
      scene.camera.lens.model != LensParameters::Model::kNone) {
    throw std::invalid_argument("simulation: the renderer draws no camera rotation; set pitch, yaw and roll to 0");
  }
  require_resolved(scene.background.texture, scene.background.depth_mm, scene.camera.alpha_px);
  for (const Plate& plate : scene.plates) {
    require_resolved(plate.texture, plate.z_mm, scene.camera.alpha_px);
    plate_.emplace_back(plate.texture, cells_for(std::max(plate.width_mm, plate.height_mm), plate.texture.pitch_mm),
                        scene.seed, "plate_texture", plate_.size());
  }
}

Renderer::Scratch Renderer::make_scratch() const {
  const auto width = static_cast<std::size_t>(scene().camera.width_px);
  const std::vector<float> row(width + kBlock);
  const std::vector<Texture::Cell> cells(kCellsPerPixel * width + 16);
  return {row, row, row, cells, cells};
}

void Renderer::render(std::uint64_t frame, std::uint8_t* pixels) const {
  Scratch scratch = make_scratch();
  render(frame, pixels, scratch);
}

void Renderer::render(std::uint64_t frame, std::uint8_t* pixels, Scratch& scratch) const {
  const double t_frame_s = static_cast<double>(frame) / scene().camera.rate_hz;
  for (int v = 0; v < scene().camera.height_px; ++v) {
    render_row(t_frame_s, v, scratch);
    add_noise(frame, v, scratch.light.data(), pixels + static_cast<std::ptrdiff_t>(v) * scene().camera.width_px);
  }
}

void Renderer::render_light(std::uint64_t frame, float* light) const {
  Scratch scratch = make_scratch();
  for (int v = 0; v < scene().camera.height_px; ++v) {
    render_row(static_cast<double>(frame) / scene().camera.rate_hz, v, scratch);
    std::copy_n(scratch.light.begin(), scene().camera.width_px,
                light + static_cast<std::ptrdiff_t>(v) * scene().camera.width_px);
  }
}

void Renderer::render_row(double t_frame_s, int v, Scratch& scratch) const noexcept {
  const double middle_s = motion_.line_time_s(t_frame_s, {0.0, static_cast<double>(v)});
  const double offset_s = motion_.exposure_offset_s();
  const Instant a{middle_s - offset_s, motion_.camera().at(middle_s - offset_s)};
  const Instant b{middle_s + offset_s, motion_.camera().at(middle_s + offset_s)};
  draw_background(a, b, v, scratch);
  scratch.light = scratch.background;
  for (int body = 0; body < scene().n_bodies(); ++body) {
    add_plate(body, a, v, scratch);
    add_plate(body, b, v, scratch);
  }
}

void Renderer::draw_background(const Instant& a, const Instant& b, int v, Scratch& scratch) const noexcept {
  const CameraParameters& camera = scene().camera;
  const double pitch = background_.pitch_mm();
  const auto look = [&](const CameraPose& pose) -> TextureRow {
    const double scale = (scene().background.depth_mm - pose.z_mm) / camera.alpha_px;  // mm per px
    return {pose.y_mm + (v - camera.cy_px) * scale, (pose.x_mm - camera.cx_px * scale) / pitch, scale / pitch};
  };
  const TextureRow row_a = look(a.pose), row_b = look(b.pose);
  const TextureRow mean{0.0, 0.5 * (row_a.x0 + row_b.x0), 0.5 * (row_a.step + row_b.step)};
  const double shift0 = 0.5 * (row_b.x0 - row_a.x0), shift_step = 0.5 * (row_b.step - row_a.step);
  float* light = scratch.background.data();
  // The motion within an exposure is a small part of a cell: then both instants merge into one polynomial per cell.
  // Beyond a cell's end that polynomial differs from its neighbour's by (shift^3) only. Otherwise both are drawn.
  if (std::max(std::abs(shift0), std::abs(shift0 + shift_step * camera.width_px)) < kLargestMerge) {
    const CellRange range = cells_of(mean, 0, camera.width_px);
    background_.row(row_a.y_mm, range.first, range.count, scratch.cells.data());
    background_.row(row_b.y_mm, range.first, range.count, scratch.other_cells.data());
    for (std::int64_t i = 0; i < range.count; ++i) {
      const double u = (static_cast<double>(range.first + i) + 0.5 - mean.x0) / mean.step;
      const auto k = static_cast<std::size_t>(i);
      mean_of_shifted(scratch.cells[k], scratch.other_cells[k], static_cast<float>(shift0 + shift_step * u));
    }
    evaluate(mean, range.first, scratch.cells.data(), 0, camera.width_px, light);
    return;
  }
  draw_texture(background_, row_a, 0, camera.width_px, scratch.cells, light);
  draw_texture(background_, row_b, 0, camera.width_px, scratch.cells, scratch.plate.data());
  for (std::size_t u = 0; u < scratch.plate.size(); ++u) light[u] = 0.5F * (light[u] + scratch.plate[u]);
}

// One of the exposure's two instants: half of what the plate covers is moved from background to plate.
void Renderer::add_plate(int body, const Instant& instant, int v, Scratch& scratch) const noexcept {
  const CameraParameters& camera = scene().camera;
  const Plate& plate = scene().plates[static_cast<std::size_t>(body)];
  const BodyPose moved = motion_.body_at(body, instant.t_s);
  const double scale = (plate.z_mm - instant.pose.z_mm) / camera.alpha_px;
  const double v_centre = camera.cy_px + (plate.y_mm + moved.y_mm - instant.pose.y_mm) / scale;
  const double half_v = 0.5 * plate.height_mm / scale;
  const double cover_v = covered(v, v_centre - half_v, v_centre + half_v);
  if (cover_v <= 0.0) return;
  const double x_mm = plate.x_mm + moved.x_mm - instant.pose.x_mm;
  const double u_centre = camera.cx_px + x_mm / scale;
  const double low = u_centre - 0.5 * plate.width_mm / scale, high = u_centre + 0.5 * plate.width_mm / scale;
  const int begin = static_cast<int>(std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(camera.width_px)));
  const int end = static_cast<int>(std::clamp(std::floor(high + 0.5) + 1.0, 0.0, static_cast<double>(camera.width_px)));
  if (begin >= end) return;

  const Texture& texture = plate_[static_cast<std::size_t>(body)];
  const double step = scale / texture.pitch_mm();
  const TextureRow row{(v - v_centre) * scale, -u_centre * step, step};  // origin at the plate's centre
  draw_texture(texture, row, begin, end, scratch.cells, scratch.plate.data());
  for (int u = begin; u < end; ++u) {
    const auto weight = static_cast<float>(0.5 * cover_v * covered(u, low, high));
    const auto i = static_cast<std::size_t>(u);
    scratch.light[i] += weight * (scratch.plate[i] - scratch.background[i]);
  }
}

void Renderer::add_noise(std::uint64_t frame, int v, const float* light, std::uint8_t* pixels) const noexcept {
  const std::uint64_t row = mix64(noise_key_ + mix64(frame) + static_cast<std::uint64_t>(v));
  quantise(light, noise_.data() + row % kNoiseTable, scene().camera.width_px, pixels);
}

}  // namespace core::simulation
