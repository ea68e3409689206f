#include "core/simulation/effects.h"

#include <algorithm>
#include <stdexcept>

namespace core::simulation {
namespace {

// A field that is zero without the effect.
using Field = double& (*)(Scene&);
template <auto section, auto member>
double& at(Scene& scene) {
  return scene.*section.*member;
}

// Effects that are not switched by a numeric field.
struct Switch {
  bool (*is_on)(const Scene&) = nullptr;
  void (*turn_off)(Scene&) = nullptr;
};
const Switch kLens{[](const Scene& s) { return s.camera.lens.model != LensParameters::Model::kNone; },
                   [](Scene& s) { s.camera.lens.model = LensParameters::Model::kNone; }};
const Switch kFlight{[](const Scene& s) { return s.flight != nullptr; }, [](Scene& s) { s.flight = nullptr; }};
const Switch kHarmonics{[](const Scene& s) { return !s.excitation.harmonics.empty(); },
                        [](Scene& s) { s.excitation.harmonics.clear(); }};
const Switch kBaseColour{[](const Scene& s) { return s.excitation.base > 0.0 && !s.excitation.base_peaks.empty(); },
                         [](Scene& s) { s.excitation.base_peaks.clear(); }};

const Switch kTailedShift{[](const Scene& s) { return s.tailed_hover.rms_mm != std::array<double, 3>{}; },
                          [](Scene& s) { s.tailed_hover.rms_mm = {}; }};
const Switch kTailedTurn{[](const Scene& s) { return s.tailed_hover.rms_rad != std::array<double, 3>{}; },
                         [](Scene& s) { s.tailed_hover.rms_rad = {}; }};

const Switch kVibration{[](const Scene& s) {
                          return s.vibration.rms_rad != std::array<double, 3>{} ||
                                 s.vibration.rms_mm != std::array<double, 3>{};
                        },
                        [](Scene& s) { s.vibration.rms_rad = s.vibration.rms_mm = {}; }};

struct Effect {
  std::string name;
  std::vector<std::string> keys;
  std::vector<Field> fields;
  Switch other{};
};

using S = Scene;
using C = CameraParameters;
using H = HoverParameters;
using R = RotorParameters;
using Ti = TimingParameters;
using L = LightParameters;
using T = TrackParameters;

// The exposure blurs, and delays the centre of every row by half its length.
const std::vector<Effect> kEffects{
    {"readout", {"camera.readout_ms"}, {at<&S::camera, &C::readout_s>}},
    {"exposure", {"camera.exposure_ms"}, {at<&S::camera, &C::exposure_s>}},
    {"lens", {"camera.lens"}, {}, kLens},
    {"mean_attitude",
     {"camera.attitude_deg"},
     {at<&S::camera, &C::pitch_rad>, at<&S::camera, &C::yaw_rad>, at<&S::camera, &C::roll_rad>}},
    {"hover_x", {"hover.x_rms_mm"}, {at<&S::hover, &H::x_rms_mm>}},
    {"hover_y", {"hover.y_rms_mm"}, {at<&S::hover, &H::y_rms_mm>}},
    {"hover_z", {"hover.z_rms_mm"}, {at<&S::hover, &H::z_rms_mm>}},
    {"pitch", {"hover.pitch_rms_deg"}, {at<&S::hover, &H::pitch_rms_rad>}},
    {"yaw", {"hover.yaw_rms_deg"}, {at<&S::hover, &H::yaw_rms_rad>}},
    {"roll", {"hover.roll_rms_deg"}, {at<&S::hover, &H::roll_rms_rad>}},
    {"zoom", {"hover.zoom_rms"}, {at<&S::hover, &H::zoom_rms>}},
    {"tailed_hover", {"tailed_hover.rms_mm", "tailed_hover.corner_hz", "tailed_hover.order"}, {}, kTailedShift},
    {"tailed_rotation",
     {"tailed_hover.rms_deg", "tailed_hover.turn_corner_hz", "tailed_hover.turn_order"},
     {},
     kTailedTurn},
    {"flight", {"flight"}, {}, kFlight},
    {"rotor",
     {"rotor"},
     {at<&S::rotor, &R::pitch_rms_rad>, at<&S::rotor, &R::yaw_rms_rad>, at<&S::rotor, &R::roll_rms_rad>}},
    {"vibration", {"vibration"}, {}, kVibration},
    {"stabiliser", {"stabiliser"}, {at<&S::stabiliser, &StabiliserParameters::gain>}},
    {"breathing", {"breathing"}, {at<&S::breathing, &BreathingParameters::rms>}},
    {"shimmer", {"shimmer"}, {at<&S::shimmer, &ShimmerParameters::rms_px>}},
    {"flap", {"flap"}, {at<&S::flap, &FlapParameters::rms_mm>}},
    {"rocking", {"rocking"}, {at<&S::rocking, &RockingParameters::rms_rad>}},
    {"torsion", {"torsion"}, {at<&S::torsion, &TorsionParameters::rms_rad>}},
    {"sway", {"sway"}, {at<&S::sway, &SwayParameters::rms_mm>}},
    {"jitter", {"timing.jitter_rms_ms"}, {at<&S::timing, &Ti::jitter_rms_s>}},
    {"drops", {"timing.drop_probability"}, {at<&S::timing, &Ti::drop_probability>}},
    {"duplicates", {"timing.duplicate_probability"}, {at<&S::timing, &Ti::duplicate_probability>}},
    {"gain", {"light.gain_rms", "light.gain_corner_hz"}, {at<&S::light, &L::gain_rms>}},
    {"flicker",
     {"light.flicker_depth", "light.flicker_hz", "light.flicker_wander_hz"},
     {at<&S::light, &L::flicker_depth>}},
    {"pixel_locking", {"tracks.pixel_locking_px"}, {at<&S::tracks, &T::pixel_locking_px>}},
    {"template_zoom", {"tracks.template_zoom_px"}, {at<&S::tracks, &T::template_zoom_px>}},
    {"brightness_bias", {"tracks.brightness_bias_px"}, {at<&S::tracks, &T::brightness_bias_px>}},
    {"harmonic", {"excitation.harmonics"}, {}, kHarmonics},
    {"base_colour", {"excitation.base_peaks"}, {}, kBaseColour},
    {"frequency_drift", {"change.frequency_drift"}, {at<&S::change, &ChangeParameters::frequency_drift>}},
    {"softening", {"change.softening"}, {at<&S::change, &ChangeParameters::softening>}},
    {"sensor_noise", {"camera.noise_sigma"}, {at<&S::camera, &C::noise_sigma>}},
    {"track_noise", {"tracks.noise_px", "tracks.noise_spread", "tracks.sigma_error"}, {at<&S::tracks, &T::noise_px>}},
    {"track_loss", {"tracks.loss_probability"}, {at<&S::tracks, &T::loss_probability>}},
    {"channel_noise", {"channels.noise_mm"}, {at<&S::channels, &ChannelParameters::noise_mm>}},
    {"channel_loss", {"channels.loss_probability"}, {at<&S::channels, &ChannelParameters::loss_probability>}},
};

bool is_active(const Effect& effect, const Scene& scene) {
  if (effect.other.is_on != nullptr) return effect.other.is_on(scene);
  Scene copy = scene;  // copied, because access to the fields is mutable
  return std::any_of(effect.fields.begin(), effect.fields.end(), [&](Field field) { return field(copy) != 0.0; });
}

const Effect& find(const std::string& name) {
  const auto found = std::find_if(kEffects.begin(), kEffects.end(), [&](const Effect& e) { return e.name == name; });
  if (found == kEffects.end()) throw std::invalid_argument("simulation: no effect is called " + name);
  return *found;
}

}  // namespace

std::vector<std::string> effect_names() {
  std::vector<std::string> names;
  for (const Effect& effect : kEffects) names.push_back(effect.name);
  return names;
}

std::vector<std::string> active_effects(const Scene& scene) {
  std::vector<std::string> names;
  for (const Effect& effect : kEffects) {
    if (is_active(effect, scene)) names.push_back(effect.name);
  }
  return names;
}

Scene without_effect(const Scene& scene, const std::string& name) {
  const Effect& effect = find(name);
  Scene without = scene;
  for (const Field field : effect.fields) field(without) = 0.0;
  if (effect.other.turn_off != nullptr) effect.other.turn_off(without);
  return without;
}

std::vector<std::string> effect_keys(const std::string& name) { return find(name).keys; }

}  // namespace core::simulation
