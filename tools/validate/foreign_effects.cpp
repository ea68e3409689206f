#include "tools/validate/foreign_effects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "core/simulation/camera/projection.h"
#include "core/types/constants.h"
#include "tools/validate/drawn_scene.h"

namespace tools {
namespace {

using core::kDegPerRad;
using core::closure::ClosureStep;
using core::simulation::Scene;
using Lens = core::simulation::LensParameters;

// A rotation whose spectrum has a power-law tail. Size: degrees rms.
template <std::size_t axis>
void set_tailed_turn(Scene& s, double size) {
  Draw draw(s.seed, "tailed_turn");
  s.tailed_hover.rms_rad[axis] = size / kDegPerRad;
  s.tailed_hover.turn_corner_hz[axis] = draw.log_uniform(0.05, 0.5);
  s.tailed_hover.turn_order[axis] = draw.uniform(3.0, 5.0);
}

// A band below half the frame rate: a vibration that is no spectral line. Size: roll, degrees rms.
void set_vibration(Scene& s, double size) {
  Draw draw(s.seed, "vibration");
  s.vibration.centre_hz = draw.log_uniform(3.5, 0.45 * s.camera.rate_hz);
  s.vibration.width_hz = draw.uniform(0.3, 1.5);
  s.vibration.rms_rad = {draw.uniform(0.1, 0.4) * size / kDegPerRad, draw.uniform(0.1, 0.4) * size / kDegPerRad,
                         size / kDegPerRad};
  s.vibration.rms_mm = {draw.uniform(0.0, 2.0) * size, draw.uniform(0.0, 2.0) * size, 0.0};
}

// Coefficients in the proportions of a real calibration; the size is |k1|.
void set_whole_lens(Scene& s, double size) {
  Draw draw(s.seed, "whole_lens");
  const double k1 = draw.sign() * size;
  s.camera.lens.model = Lens::Model::kRadialTangential;
  s.camera.lens.k = {k1, -draw.uniform(0.2, 0.5) * k1, draw.uniform(-0.005, 0.005) * size,
                     draw.uniform(-0.005, 0.005) * size, draw.uniform(-0.1, 0.1) * k1};
}
void set_second_term(Scene& s, double size) {
  s.camera.lens.model = Lens::Model::kRadialTangential;
  s.camera.lens.k = {0.0, Draw(s.seed, "second_term").sign() * size, 0.0, 0.0, 0.0};
}
// From the tangent (size 0; its series) to an equidistant lens (size 1).
void set_fisheye(Scene& s, double size) {
  const double rest = 1.0 - size;
  s.camera.lens.model = Lens::Model::kEquidistant;
  s.camera.lens.k = {rest / 3.0, rest * 2.0 / 15.0, rest * 17.0 / 315.0, rest * 62.0 / 2835.0, 0.0};
}

// The camera stands to one side and is aimed at the middle of the structure. Size: degrees.
void set_oblique(Scene& s, double size) {
  const bool aside = Draw(s.seed, "oblique").sign() > 0.0;
  const double turn = Draw(s.seed, "oblique_way").sign() * size / kDegPerRad;
  (aside ? s.camera.yaw_rad : s.camera.pitch_rad) = turn;
  const Eigen::Vector3d ahead = core::simulation::attitude(s.camera.pitch_rad, s.camera.yaw_rad, 0.0).col(2);
  double y_mm = 0.0;
  for (const auto& plate : s.plates) y_mm += plate.y_mm / s.n_bodies();
  const double depth_mm = s.plates[0].z_mm;
  s.camera.x_mm = -depth_mm * ahead.x();
  s.camera.y_mm = y_mm - depth_mm * ahead.y();
  s.camera.z_mm = depth_mm * (1.0 - ahead.z());
}

void set_flap(Scene& s, double size) {
  Draw draw(s.seed, "flap");
  s.flap.body = draw.whole(1, s.n_bodies() - 1);
  s.flap.from_share = draw.uniform(0.4, 0.6);
  s.flap.frequency_hz = draw.log_uniform(2.0, 9.0);
  s.flap.damping_ratio = draw.log_uniform(0.005, 0.05);
  s.flap.rms_mm = size;
}
void set_shimmer(Scene& s, double size) {
  Draw draw(s.seed, "shimmer");
  const double angle = 2.0 * std::numbers::pi * draw.uniform(0.0, 1.0), speed = draw.log_uniform(20.0, 200.0);
  s.shimmer.rms_px = size;
  s.shimmer.outer_px = draw.log_uniform(200.0, 1000.0);
  s.shimmer.inner_px = draw.log_uniform(20.0, 100.0);
  s.shimmer.drift_px_s = {speed * std::cos(angle), speed * std::sin(angle)};
  s.shimmer.boiling_px_s = draw.uniform(0.2, 0.8) * speed;
}
template <auto member>
void set_turning(Scene& s, double size) {  // degrees
  Draw draw(s.seed, "turning");
  (s.*member).frequency_hz = draw.log_uniform(1.5, 8.0);
  (s.*member).damping_ratio = draw.log_uniform(0.005, 0.05);
  (s.*member).rms_rad = size / kDegPerRad;
}
void set_sway(Scene& s, double size) {  // mm
  Draw draw(s.seed, "sway");
  s.sway.frequency_hz = draw.log_uniform(0.8, 6.0);
  s.sway.damping_ratio = draw.log_uniform(0.005, 0.05);
  s.sway.rms_mm = size;
}
void set_stabiliser(Scene& s, double size) {
  Draw draw(s.seed, "stabiliser");
  s.stabiliser.corner_hz = draw.log_uniform(0.2, 2.0);
  s.stabiliser.lag_s = draw.uniform(0.0, 0.1);
  s.stabiliser.gain = size;
}
void set_breathing(Scene& s, double size) {
  Draw draw(s.seed, "breathing");
  s.breathing.corner_hz = draw.log_uniform(0.1, 1.0);
  s.breathing.centre_px = {draw.uniform(-300.0, 300.0), draw.uniform(-200.0, 200.0)};
  s.breathing.rms = size;
}
void set_template_zoom(Scene& s, double size) { s.tracks.template_zoom_px = size; }
// Lamps at twice the mains frequency, whose beat with the frame rate is slow or fast.
void set_flicker(Scene& s, double size) {
  Draw draw(s.seed, "flicker");
  s.light.flicker_hz = (draw.sign() > 0.0 ? 100.0 : 120.0) + draw.uniform(-0.2, 0.2);
  s.light.flicker_depth = 0.3;
  s.light.flicker_wander_hz = draw.log_uniform(0.002, 0.03);
  s.tracks.brightness_bias_px = size;
}

std::vector<KnownValue> whole_lens(const Scene& s, const Scene&) {
  const auto& k = s.camera.lens.k;
  return {{"k1", k[0]}, {"k2", k[1]}, {"p1", k[2]}, {"p2", k[3]}, {"k3", k[4]}};
}
std::vector<KnownValue> second_term(const Scene& s, const Scene&) { return {{"k2", s.camera.lens.k[1]}}; }
std::vector<KnownValue> unknown(const Scene&, const Scene&) { return {}; }

const std::vector<std::string> kLensNames{"lens", "lens distortion", "radial distortion", "tangential distortion",
                                          "equidistant lens"};

std::vector<ForeignEffect> all_effects() {
  std::vector<ForeignEffect> all;
  for (const HiddenEffect& effect : hidden_effects()) {
    ForeignEffect one{effect, {effect.called}};
    if (effect.called == "radial distortion" || effect.called == "tangential distortion") one.names = kLensNames;
    if (effect.name == "camera pitch") one.effect.set = set_tailed_turn<0>;
    if (effect.name == "camera yaw") one.effect.set = set_tailed_turn<1>;
    if (effect.name == "camera roll") one.effect.set = set_tailed_turn<2>;
    if (effect.name == "roll above 5 Hz") one.names.emplace_back("camera vibration");
    all.push_back(one);
  }
  const auto add = [&](const char* name, double most, double start, auto* set, std::vector<std::string> names,
                       auto* truth) {
    all.push_back({{name, names.front(), most, start, set, truth}, names});
  };
  add("gimbal vibration", 2.0, 0.01, set_vibration, {"camera vibration"}, unknown);
  add("whole lens", 0.4, 0.01, set_whole_lens, kLensNames, whole_lens);
  add("second radial term", 1.0, 0.02, set_second_term, kLensNames, second_term);
  add("fisheye", 1.0, 0.05, set_fisheye, {"equidistant lens", "lens", "lens distortion", "radial distortion"}, unknown);
  add("oblique view", 24.0, 1.0, set_oblique, {"oblique view", "view not perpendicular"}, unknown);
  add("flap", 50.0, 0.05, set_flap, {"own motion of a part", "moving part"}, unknown);
  add("shimmer", 5.0, 0.02, set_shimmer, {"refraction of the air", "shimmer"}, unknown);
  add("rocking", 2.0, 0.002, set_turning<&Scene::rocking>, {"rocking", "base rocking", "rigid motion"}, unknown);
  add("torsion", 5.0, 0.02, set_turning<&Scene::torsion>, {"torsion", "rigid motion"}, unknown);
  add("sway", 100.0, 0.1, set_sway, {"moving background", "background motion"}, unknown);
  all.back().in_background = true;
  add("stabiliser", 1.0, 0.1, set_stabiliser, {"stabiliser", "stabilisation"}, unknown);
  add("focus breathing", 0.05, 1e-4, set_breathing, {"focus breathing"}, unknown);
  add("template zoom", 20.0, 0.5, set_template_zoom, {"template zoom"}, unknown);
  add("flicker", 5.0, 0.1, set_flicker, {"flicker", "flicker bands", "light"}, unknown);
  return all;
}

bool names_it(const ForeignEffect& effect, const ClosureStep& step) {
  return std::find(effect.names.begin(), effect.names.end(), step.effect) != effect.names.end();
}

}  // namespace

const std::vector<ForeignEffect>& foreign_effects() {
  static const std::vector<ForeignEffect> all = all_effects();
  return all;
}

const char* word_for(Answer answer) noexcept {
  constexpr std::array kWords{"named", "latent", "misnamed", "part", "nothing"};
  return kWords[static_cast<std::size_t>(answer)];
}

Answer answer_of(const std::vector<ClosureStep>& steps, const std::vector<const ForeignEffect*>& effects) {
  if (steps.empty()) return Answer::kNothing;
  const auto is_latent = [](const ClosureStep& step) { return step.kind == core::closure::EffectKind::kLatent; };
  bool latent = false;
  for (const ClosureStep& step : steps) {
    if (is_latent(step)) {
      latent = true;
    } else if (std::none_of(effects.begin(), effects.end(), [&](const auto* e) { return names_it(*e, step); })) {
      return Answer::kMisnamed;
    }
  }
  const bool all = std::all_of(effects.begin(), effects.end(), [&](const ForeignEffect* effect) {
    return std::any_of(steps.begin(), steps.end(), [&](const ClosureStep& step) { return names_it(*effect, step); });
  });
  if (latent) return Answer::kLatent;
  return all ? Answer::kNamed : Answer::kPart;
}

std::vector<double> errors_in_sigmas(const std::vector<ClosureStep>& steps, const ForeignEffect& effect,
                                     const std::vector<KnownValue>& truth) {
  std::vector<double> errors;
  for (const ClosureStep& step : steps) {
    if (!names_it(effect, step)) continue;
    for (const auto& stated : step.parameters) {
      const auto known = std::find_if(truth.begin(), truth.end(), [&](const auto& t) { return t.name == stated.name; });
      if (known != truth.end() && stated.sigma && *stated.sigma > 0.0)
        errors.push_back((stated.value - known->value) / *stated.sigma);
    }
  }
  return errors;
}

const ForeignEffect& foreign_effect_named(const std::string& name) {
  const auto& all = foreign_effects();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& e) { return e.effect.name == name; });
  if (found == all.end()) throw std::invalid_argument("no effect is called " + name);
  return *found;
}

bool share_a_name(const ForeignEffect& a, const ForeignEffect& b) {
  return std::any_of(a.names.begin(), a.names.end(), [&](const std::string& name) {
    return std::find(b.names.begin(), b.names.end(), name) != b.names.end();
  });
}

}  // namespace tools
