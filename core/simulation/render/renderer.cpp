#include "core/simulation/render/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "core/simulation/render/render_row.h"
#include "core/simulation/render/render_textures.h"

namespace core::simulation {
namespace {

bool by_rows(const Scene& scene) { return reads_rows(scene.camera.readout_direction); }

bool looks_straight(const SceneMotion& motion) {
  const CameraParameters& camera = motion.scene().camera;
  const bool turned =
      motion.camera().rotates() || camera.pitch_rad != 0.0 || camera.yaw_rad != 0.0 || camera.roll_rad != 0.0;
  return !turned && !motion.structure().tilts() && !motion.own().rocks() && motion.scene().flap.rms_mm <= 0.0 &&
         camera.lens.model == LensParameters::Model::kNone;
}

// Refuses scenes with effects that images do not show.
const Scene& drawable(const Scene& scene) {
  const auto refuse = [](bool there, const char* what) {
    if (there)
      throw std::invalid_argument(std::string("simulation: pictures do not show ") + what +
                                  "; leave it out, or make tracks");
  };
  refuse(scene.torsion.rms_rad > 0.0, "torsion (torsion.rms_deg)");
  refuse(scene.shimmer.rms_px > 0.0, "shimmer (shimmer.rms_px)");
  refuse(scene.stabiliser.gain > 0.0, "electronic stabilisation (stabiliser.gain)");
  refuse(scene.breathing.rms > 0.0, "focus breathing (breathing.rms)");
  return scene;
}

// Nearest first; of plates at the same depth, the first in the list.
std::vector<std::size_t> front_to_back(const std::vector<Plate>& plates) {
  std::vector<std::size_t> order(plates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return plates[a].z_mm < plates[b].z_mm; });
  return order;
}

}  // namespace

Renderer::Renderer(const Scene& scene, Way way)
    : motion_(drawable(scene)),
      light_(scene),
      rays_(scene.camera, scene.hover.zoom_rms),
      sensor_(scene),
      background_(background_texture(scene)),
      plate_(plate_textures(scene)),
      front_to_back_(front_to_back(scene.plates)),
      rows_(by_rows(scene)),
      quick_(way == Way::kQuickest && rows_ && looks_straight(motion_)) {}

int Renderer::n_lines() const noexcept { return rows_ ? scene().camera.height_px : scene().camera.width_px; }

int Renderer::line_length() const noexcept { return rows_ ? scene().camera.width_px : scene().camera.height_px; }

Renderer::Scratch Renderer::make_scratch() const {
  return RenderLine(line_length(), quick_ ? most_cells(line_length()) : 0);
}

DeliveredFrame Renderer::undisturbed(std::uint64_t number) const noexcept {
  const double t_s = static_cast<double>(number) / scene().camera.rate_hz;
  return {number, t_s, t_s, number, false};
}

void Renderer::render(std::uint64_t number, std::uint8_t* pixels) const {
  Scratch scratch = make_scratch();
  render(undisturbed(number), pixels, scratch);
}

void Renderer::render(std::uint64_t number, std::uint8_t* pixels, Scratch& scratch) const {
  render(undisturbed(number), pixels, scratch);
}

void Renderer::render(const DeliveredFrame& frame, std::uint8_t* pixels, Scratch& scratch) const {
  const int length = line_length();
  const std::ptrdiff_t width = scene().camera.width_px;
  for (int index = 0; index < n_lines(); ++index) {
    draw_line(frame.t_s, index, scratch);
    std::uint8_t* line = rows_ ? pixels + index * width : scratch.pixels.data();
    sensor_.expose(frame.number, index, scratch.light.data(), length, line);
    if (rows_) continue;
    for (std::ptrdiff_t v = 0; v < length; ++v) pixels[v * width + index] = line[v];
  }
}

void Renderer::render_light(std::uint64_t number, float* light) const { render_light(undisturbed(number).t_s, light); }

void Renderer::render_light(double t_frame_s, float* light) const {
  Scratch scratch = make_scratch();
  const std::ptrdiff_t width = scene().camera.width_px;
  for (int index = 0; index < n_lines(); ++index) {
    draw_line(t_frame_s, index, scratch);
    for (std::ptrdiff_t i = 0; i < line_length(); ++i) {
      light[rows_ ? index * width + i : i * width + index] = scratch.light[static_cast<std::size_t>(i)];
    }
  }
}

void Renderer::draw_line(double t_frame_s, int index, RenderLine& line) const noexcept {
  const ImagePoint on_line{rows_ ? 0.0 : index, rows_ ? index : 0.0};
  const double middle_s = motion_.line_time_s(t_frame_s, on_line), offset_s = motion_.exposure_offset_s();
  line.begin();
  const Instant a = instant_at(middle_s - offset_s), b = instant_at(middle_s + offset_s);
  if (quick_) {
    draw_row(a, b, index, line);
  } else {
    draw_any_line(a, b, index, line);
  }
  if (light_.constant()) return;
  const auto factor = static_cast<float>(light_.factor(middle_s));
  for (float& grey : line.light) grey *= factor;
}

void Renderer::draw_row(const Instant& a, const Instant& b, int v, RenderLine& line) const noexcept {
  const CameraParameters& camera = scene().camera;
  const double pitch = background_.pitch_mm();
  const auto look = [&](const CameraPose& pose, double sway_mm) -> TextureRow {
    const double scale = (scene().background.depth_mm - pose.z_mm) / (camera.alpha_px * pose.zoom);  // mm per px
    return {pose.y_mm + (v - camera.cy_px) * scale, (pose.x_mm - sway_mm - camera.cx_px * scale) / pitch,
            scale / pitch};
  };
  draw_background_row(background_, look(a.pose, motion_.own().sway_mm(a.t_s)),
                      look(b.pose, motion_.own().sway_mm(b.t_s)), camera.width_px, line);
  line.light = line.background;
  for (const std::size_t body : front_to_back_) {
    add_plate_row(body, a, 0, v, line);
    add_plate_row(body, b, 1, v, line);
  }
}

// One of the two instants of the exposure: half of the area that the plate covers is moved from background to plate.
void Renderer::add_plate_row(std::size_t body, const Instant& instant, std::size_t i_instant, int v,
                             RenderLine& line) const noexcept {
  const CameraParameters& camera = scene().camera;
  const Plate& plate = scene().plates[body];
  const BodyPose moved = motion_.body_at(static_cast<int>(body), instant.t_s);
  const double scale = (plate.z_mm - instant.pose.z_mm) / (camera.alpha_px * instant.pose.zoom);
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

  const double step = scale / plate_[body].pitch_mm();
  const TextureRow row{(v - v_centre) * scale, -u_centre * step, step};  // origin at the plate's centre
  draw_texture_row(plate_[body], row, begin, end, line, line.plate.data());
  for (int u = begin; u < end; ++u) {
    line.cover[static_cast<std::size_t>(u)] = static_cast<float>(cover_v * covered(u, low, high));
  }
  lay_plate(line, begin, end, i_instant, 0.5F);
}

void Renderer::draw_any_line(const Instant& a, const Instant& b, int index, RenderLine& line) const noexcept {
  const CameraParameters& camera = scene().camera;
  const auto trace = [&](const CameraPose& pose, std::size_t i) -> LineRays {
    double *x = line.ray_x[i].data(), *y = line.ray_y[i].data();
    rows_ ? rays_.row(index, pose.zoom, x, y) : rays_.column(index, pose.zoom, x, y);
    const int n = line_length();
    std::fill_n(x + n, Texture::kLook, x[n - 1]);
    std::fill_n(y + n, Texture::kLook, y[n - 1]);
    return {x, y, n, camera, pose.zoom};
  };
  const auto draw = [&](const Instant& instant, const LineRays& rays, std::vector<float>& light) {
    const CameraPose& pose = instant.pose;
    // Subtracting whole periods of the texture keeps the numbers small wherever the camera is.
    const double period_mm = background_.period_mm();
    const PlanePoint origin{period_mm * std::round(pose.x_mm / period_mm),
                            period_mm * std::round(pose.y_mm / period_mm)};
    const PlanePoint moved{origin.x_mm + motion_.own().sway_mm(instant.t_s), origin.y_mm};
    const PlaneView view(pose, moved, 0.0, scene().background.depth_mm, background_.pitch_mm());
    draw_plane(view, background_, rays, 0, line_length(), light.data());
  };
  const bool blurred = b.t_s > a.t_s;
  const LineRays rays_a = trace(a.pose, 0), rays_b = b.pose.zoom == a.pose.zoom ? rays_a : trace(b.pose, 1);
  draw(a, rays_a, line.background);
  if (blurred) {
    draw(b, rays_b, line.plate);
    for (std::size_t u = 0; u < line.plate.size(); ++u) {
      line.background[u] = 0.5F * (line.background[u] + line.plate[u]);
    }
  }
  line.light = line.background;
  for (const std::size_t body : front_to_back_) {
    add_plate(body, a, rays_a, 0, blurred ? 0.5F : 1.0F, line);
    if (blurred) add_plate(body, b, rays_b, 1, 0.5F, line);
  }
}

void Renderer::add_plate(std::size_t body, const Instant& instant, const LineRays& rays, std::size_t i_instant,
                         float weight, RenderLine& line) const noexcept {
  const double width_mm = scene().plates[body].width_mm;
  const FlapParameters& flap = scene().flap;
  if (flap.rms_mm <= 0.0 || flap.body != static_cast<int>(body)) {
    add_part(body, {-0.5 * width_mm, 0.5 * width_mm, 0.0, 0.0}, instant, rays, i_instant, weight, line);
    return;
  }
  const double from_mm = (flap.from_share - 0.5) * width_mm, moved_mm = motion_.own().flap_mm(instant.t_s);
  const bool along_x = scene().structure.axis == StructureModel::Axis::kX;
  add_part(body, {-0.5 * width_mm, from_mm, 0.0, 0.0}, instant, rays, i_instant, weight, line);
  add_part(body, {from_mm, 0.5 * width_mm, along_x ? moved_mm : 0.0, along_x ? 0.0 : moved_mm}, instant, rays,
           i_instant, weight, line);
}

void Renderer::add_part(std::size_t body, const PlatePart& part, const Instant& instant, const LineRays& rays,
                        std::size_t i_instant, float weight, RenderLine& line) const noexcept {
  if (part.high_mm <= part.low_mm) return;
  const Plate& plate = scene().plates[body];
  const BodyPose moved = motion_.body_at(static_cast<int>(body), instant.t_s);
  const double pitch = plate_[body].pitch_mm(), c = std::cos(moved.tilt_rad), s = std::sin(moved.tilt_rad);
  const auto view_from = [&](double x_mm, double y_mm) -> PlaneView {  // of a place in the plate's axes
    return {instant.pose,
            {plate.x_mm + moved.x_mm + c * x_mm - s * y_mm, plate.y_mm + moved.y_mm + s * x_mm + c * y_mm},
            moved.tilt_rad,
            plate.z_mm,
            pitch};
  };
  const double middle_mm = 0.5 * (part.low_mm + part.high_mm);
  const PixelRange range =
      cover_plate(view_from(middle_mm + part.x_mm, part.y_mm), 0.5 * (part.high_mm - part.low_mm) / pitch,
                  0.5 * plate.height_mm / pitch, rays, line.cover.data());
  if (range.begin >= range.end) return;
  draw_plane(view_from(part.x_mm, part.y_mm), plate_[body], rays, range.begin, range.end, line.plate.data());
  lay_plate(line, range.begin, range.end, i_instant, weight);
}

}  // namespace core::simulation
