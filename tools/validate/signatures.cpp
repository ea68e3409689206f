#include "tools/validate/signatures.h"

#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <numbers>

#include "core/simulation/presets.h"
#include "core/simulation/random_stream.h"
#include "core/simulation/track_generator.h"
#include "core/types/constants.h"
#include "tools/validate/signature_cases.h"

namespace tools {

using core::simulation::ImagePoint;
using core::simulation::Scene;
using core::simulation::TrackGenerator;

ImagePoint motion_field(const Sight& s, const std::array<double, 7>& m) {
  const auto& [tx, ty, tz, wx, wy, wz, zoom] = m;
  const double x = s.x, y = s.y, z = s.depth_mm;
  return {s.alpha_px() * (-tx / z + x * tz / z + x * y * wx - (1 + x * x) * wy + y * wz + x * zoom),
          s.alpha_px() * (-ty / z + y * tz / z + (1 + y * y) * wx - x * y * wy - x * wz + y * zoom)};
}

ImagePoint with_line_time(const Sight& s, ImagePoint field) {
  const auto& camera = s.without.motion().scene().camera;
  const ImagePoint v = s.velocity();
  const double dv = field.v_px / (1.0 - v.v_px * camera.readout_s / camera.height_px);
  return {field.u_px + v.u_px * camera.readout_s / camera.height_px * dv, dv};
}

ImagePoint camera_signature(const Sight& s) {
  auto with = s.with.motion().camera().deviation(s.t_s);
  const auto without = s.without.motion().camera().deviation(s.t_s);
  for (std::size_t i = 0; i < with.size(); ++i) with[i] -= without[i];
  return with_line_time(s, motion_field(s, with));
}

namespace {

using core::kTwoPi;
constexpr std::uint64_t kFrames = 250, kEvery = 7;

// As camera_signature(), for sinusoidal motion within the exposure: its mean is sinc(f T) times the value at its
// middle.
ImagePoint rotor_signature(const Sight& s) {
  const auto& scene = s.with.motion().scene();
  const double half_turn = std::numbers::pi * scene.rotor.frequency_hz * scene.camera.exposure_s;
  const ImagePoint sharp = camera_signature(s);
  const double loss = std::sin(half_turn) / half_turn;
  return {loss * sharp.u_px, loss * sharp.v_px};
}

ImagePoint lens_signature(const Sight& s) {
  const auto& [k1, k2, p1, p2, k3] = s.with.motion().scene().camera.lens.k;
  const double x = s.x, y = s.y, r2 = x * x + y * y, radial = r2 * (k1 + r2 * (k2 + r2 * k3));
  const double dx = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double dy = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  return with_line_time(s, {s.alpha_px() * dx, s.alpha_px() * dy});
}

ImagePoint readout_signature(const Sight& s) {
  const auto &a = s.without.motion().scene().camera, &b = s.with.motion().scene().camera;
  const double late_s = (b.readout_s - a.readout_s) * s.image.v_px / a.height_px;
  return {s.velocity().u_px * late_s, s.velocity().v_px * late_s};
}

// A longer exposure ends later: its middle moves by half the difference, and its mean includes more of the curvature.
ImagePoint exposure_signature(const Sight& s) {
  const double t0 = s.without.motion().scene().camera.exposure_s, t1 = s.with.motion().scene().camera.exposure_s;
  const double late_s = 0.5 * (t1 - t0), bent_s2 = (t1 * t1 - t0 * t0) / 24.0 + 0.5 * late_s * late_s;
  const ImagePoint v = s.velocity(), a = s.acceleration();
  return {v.u_px * late_s + a.u_px * bent_s2, v.v_px * late_s + a.v_px * bent_s2};
}

// An error of the time stamp: velocity and curvature times that error.
ImagePoint time_signature(const Sight& s) {
  const double late_s = s.frame_with.t_s - s.frame.t_s;
  const ImagePoint v = s.velocity(), a = s.acceleration();
  return {v.u_px * late_s + 0.5 * a.u_px * late_s * late_s, v.v_px * late_s + 0.5 * a.v_px * late_s * late_s};
}

// The picture of another instant, a whole number of frames away.
ImagePoint other_frame_signature(const Sight& s) {
  const ImagePoint then = s.seen_at(s.frame_with.t_s);
  return {then.u_px - s.image.u_px, then.v_px - s.image.v_px};
}

// A force on the roof: the modal sum, scaled to the roof's own rms; the phase is taken from the scene.
ImagePoint harmonic_signature(const Sight& s) {
  const Scene& scene = s.with.motion().scene();
  if (s.point().body < 1) return {};
  const auto& harmonic = scene.excitation.harmonics.front();
  const Eigen::MatrixXd shapes = core::simulation::shear_chain_shapes(6);
  const auto modes = core::simulation::modes_of(s.without.motion().scene().structure);
  const double w = kTwoPi * harmonic.frequency_hz;
  std::complex<double> own = 0.0, roof = 0.0;
  for (Eigen::Index r = 0; r < 6; ++r) {
    const auto& mode = modes[static_cast<std::size_t>(r)];
    const double wr = kTwoPi * mode.frequency_hz;
    const auto term = shapes(5, r) / shapes.col(r).squaredNorm() /
                      std::complex<double>(wr * wr - w * w, 2 * mode.damping_ratio * wr * w);
    own += shapes(s.point().body - 1, r) * term;
    roof += shapes(5, r) * term;
  }
  // Roof motion by the force alone, at the time and a quarter of a period before: the complex amplitude.
  const auto alone = [&](double t_s) {
    return s.with.motion().structure().displacement_mm(6, t_s) - s.without.motion().structure().displacement_mm(6, t_s);
  };
  const std::complex<double> roof_mm(alone(s.t_s), alone(s.t_s - 0.25 / harmonic.frequency_hz));
  const double half_turn = 0.5 * w * scene.camera.exposure_s;
  const double loss = std::sin(half_turn) / half_turn;
  return {s.alpha_px() / s.depth_mm * loss * (own / roof * roof_mm).real(), 0.0};
}

double sub_pixel_wave(double at_px) { return std::sin(kTwoPi * at_px) + 0.25 * std::sin(2 * kTwoPi * at_px + 0.5); }

ImagePoint locking_signature(const Sight& s) {
  const double a = s.with.motion().scene().tracks.pixel_locking_px;
  return {a * sub_pixel_wave(s.image.u_px), a * sub_pixel_wave(s.image.v_px)};
}

// Lamps: a row's light is averaged over its exposure, sinc(f T) of the lamps'; a point's error has its own direction.
ImagePoint flicker_signature(const Sight& s) {
  const Scene& scene = s.with.motion().scene();
  const double half_turn = std::numbers::pi * scene.light.flicker_hz * scene.camera.exposure_s;
  const double phase = kTwoPi * core::simulation::RandomStream(scene.seed, "flicker_phase").uniform();
  const double light = scene.light.flicker_depth * std::sin(half_turn) / half_turn *
                       std::cos(kTwoPi * scene.light.flicker_hz * s.t_s + phase);
  const double bias_px = scene.tracks.brightness_bias_px * light;
  return {bias_px * s.point().bias_u, bias_px * s.point().bias_v};
}

std::vector<SignatureCase> cases() {
  using Lens = core::simulation::LensParameters;
  const auto lens = [](std::size_t i, double k) {
    return [i, k](Scene& s) { s.camera.lens.model = Lens::Model::kRadialTangential, s.camera.lens.k[i] = k; };
  };
  return {{"drift x", [](Scene& s) { s.hover.x_rms_mm = 0.05; }, camera_signature},
          {"drift y", [](Scene& s) { s.hover.y_rms_mm = 0.05; }, camera_signature},
          {"drift z", [](Scene& s) { s.hover.z_rms_mm = 0.2; }, camera_signature},
          {"pitch", [](Scene& s) { s.hover.pitch_rms_rad = 2e-5; }, camera_signature},
          {"yaw", [](Scene& s) { s.hover.yaw_rms_rad = 2e-5; }, camera_signature},
          {"roll", [](Scene& s) { s.hover.roll_rms_rad = 5e-5; }, camera_signature},
          {"zoom", [](Scene& s) { s.hover.zoom_rms = 5e-5; }, camera_signature},
          {"rotor line", [](Scene& s) { s.rotor.pitch_rms_rad = 1e-5; }, rotor_signature},
          {"lens k1", lens(0, 1e-3), lens_signature},
          {"lens k2", lens(1, 1e-2), lens_signature},
          {"lens p1", lens(2, 2e-4), lens_signature},
          {"lens p2", lens(3, 2e-4), lens_signature},
          {"readout", [](Scene& s) { s.camera.readout_s += 2e-4; }, readout_signature},
          {"exposure", [](Scene& s) { s.camera.exposure_s += 4e-4; }, exposure_signature},
          {"jitter",
           [](Scene& s) {
             s.timing = {5e-4, 0.0, 0.0, false};
           },
           time_signature},
          {"drops",
           [](Scene& s) {
             s.timing = {0.0, 0.02, 0.0, false};
           },
           other_frame_signature},
          {"duplicates",
           [](Scene& s) {
             s.timing = {0.0, 0.0, 0.05, false};
           },
           other_frame_signature},
          {"harmonic",
           [](Scene& s) {
             s.excitation.harmonics = {{6, 3.3, 0.05}};
           },
           harmonic_signature},
          {"pixel locking", [](Scene& s) { s.tracks.pixel_locking_px = 0.01; }, locking_signature},
          {"flicker", [](Scene& s) { s.light.flicker_depth = 0.1, s.light.flicker_hz = 97.0; }, flicker_signature}};
}

Scene undisturbed(std::uint64_t seed) {
  Scene scene = core::simulation::make_paper_scene(seed, 10.0);
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  scene.tracks.points_per_region = 4;
  scene.tracks.noise_px = 0.0;
  scene.tracks.brightness_bias_px = 0.3;
  return scene;
}

SignatureCheck check(const SignatureCase& which, std::uint64_t seed) {
  Scene scene = undisturbed(seed);
  if (which.prepare) which.prepare(scene);
  const TrackGenerator without(scene);
  which.add(scene);
  const TrackGenerator with(scene);
  auto timing = without.timing(), timing_with = with.timing();
  core::TrackFrame a, b;
  core::simulation::DeliveredFrame frame, frame_with;
  double effect2 = 0.0, miss2 = 0.0;
  std::size_t n = 0;
  const auto& camera = without.motion().scene().camera;
  for (std::uint64_t k = 0; k < kFrames && timing.next(frame) && timing_with.next(frame_with); ++k) {
    if (k % kEvery != 0 && frame.number == frame_with.number) continue;
    without.generate(frame, a);
    with.generate(frame_with, b);
    for (std::size_t i = 0; i < a.points.size(); ++i, ++n) {
      const ImagePoint image{a.points[i].u_px, a.points[i].v_px};
      const Sight sight{without,
                        with,
                        i,
                        frame,
                        frame_with,
                        image,
                        (image.u_px - camera.cx_px) / camera.alpha_px,
                        (image.v_px - camera.cy_px) / camera.alpha_px,
                        without.motion().depth_mm(without.points()[i].body),
                        without.motion().line_time_s(frame.t_s, image)};
      const ImagePoint expected = which.signature(sight);
      const double du = b.points[i].u_px - image.u_px, dv = b.points[i].v_px - image.v_px;
      effect2 += du * du + dv * dv;
      miss2 += std::pow(du - expected.u_px, 2) + std::pow(dv - expected.v_px, 2);
    }
  }
  return {which.effect, std::sqrt(effect2 / static_cast<double>(n)), std::sqrt(miss2 / effect2)};
}

}  // namespace

std::vector<SignatureCheck> check_signatures(std::uint64_t seed) {
  std::vector<SignatureCheck> checks;
  for (const auto& list : {cases(), injected_cases()}) {
    for (const SignatureCase& which : list) checks.push_back(check(which, seed));
  }
  return checks;
}

}  // namespace tools
