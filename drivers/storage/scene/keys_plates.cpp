#include <utility>

#include "drivers/storage/scene/key.h"

namespace drivers {
namespace {

using core::simulation::ExcitationParameters;
using core::simulation::Plate;
using core::simulation::TextureParameters;

template <auto member>
auto& made(SceneFile& file, std::size_t) {
  return file.plates.*member;
}
template <auto member>
auto& plate(SceneFile& file, std::size_t i) {
  return file.scene.plates[i].*member;
}
template <auto member>
auto& excitation(SceneFile& file, std::size_t) {
  return file.scene.excitation.*member;
}
template <auto member>
auto& peak(SceneFile& file, std::size_t i) {
  return file.scene.excitation.base_peaks[i].*member;
}
template <auto member>
auto& harmonic(SceneFile& file, std::size_t i) {
  return file.scene.excitation.harmonics[i].*member;
}

SceneKey never_written(SceneKey key) {
  key.applies = [](const SceneFile&) { return false; };
  return key;
}

using Shows = TextureParameters::Shows;
using TextureOf = TextureParameters& (*)(SceneFile&, std::size_t);

std::vector<SceneKey> texture_keys(const std::string& section, TextureOf of) {
  const auto at = [of](double TextureParameters::*member) -> SceneField<double> {
    return [of, member](SceneFile& file, std::size_t i) -> double& { return of(file, i).*member; };
  };
  return {scene_number(section + ".pitch_mm", "mm", at(&TextureParameters::pitch_mm), {0.0, 1e5},
                       "grid of the texture, content up to 0.55 / pitch; 0 = 2.75 px of the image (background: 7)"),
          scene_number(section + ".mean", "grey levels", at(&TextureParameters::mean), {0.0, 255.0}, "brightness"),
          scene_number(section + ".contrast_rms", "grey levels", at(&TextureParameters::contrast_rms), {0.0, 128.0},
                       "strength of the texture; more than 0, or nothing can be tracked there"),
          scene_choice<Shows>(
              section + ".shows", [of](SceneFile& file, std::size_t i) -> Shows& { return of(file, i).shows; },
              {{"noise", Shows::kNoise}, {"facade", Shows::kFacade}, {"landscape", Shows::kLandscape}},
              "beside the noise: facade, of plates: one storey with windows; landscape, of the background: sky, town, "
              "ground")};
}

void add_plate_list_keys(std::vector<SceneKey>& keys) {
  keys.push_back(
      scene_name("plates[].name", plate<&Plate::name>, "of the body that it shows; the first is the ground"));
  keys.push_back(scene_tuple("plates[].centre_mm", "mm",
                             {plate<&Plate::x_mm>, plate<&Plate::y_mm>, plate<&Plate::z_mm>}, 3, {-1e7, 1e7},
                             "[right, down, ahead], at rest"));
  keys.push_back(scene_tuple("plates[].size_mm", "mm", {plate<&Plate::width_mm>, plate<&Plate::height_mm>}, 2,
                             {1.0, 1e6}, "[width, height]"));
  for (SceneKey& key : texture_keys("plates[].texture", plate<&Plate::texture>)) keys.push_back(std::move(key));
}

}  // namespace

void add_plate_keys(std::vector<SceneKey>& keys) {
  using P = ScenePlates;
  using B = core::simulation::BackgroundParameters;
  add_plate_list_keys(keys);
  std::vector<SceneKey> made_keys{
      scene_number("plates.width_mm", "mm", made<&P::width_mm>, {1.0, 1e6},
                   "instead of a list: of each plate, made where the structure's bodies are"),
      scene_number("plates.height_mm", "mm", made<&P::height_mm>, {1.0, 1e6}, "of each plate that is made"),
      scene_number("plates.spacing_mm", "mm", made<&P::spacing_mm>, {0.0, 1e6},
                   "from centre to centre; 0 = as the structure's dimensions say, or 140"),
      scene_number("plates.depth_mm", "mm", made<&P::depth_mm>, {-1e7, 1e7}, "distance ahead of the origin")};
  for (SceneKey& key : texture_keys(
           "plates.texture", [](SceneFile&file, std::size_t) -> TextureParameters& { return file.plates.texture; })) {
    made_keys.push_back(std::move(key));
  }
  for (SceneKey& key : made_keys) keys.push_back(never_written(std::move(key)));
  keys.push_back(scene_number(
      "background.depth_mm", "mm",
      [](SceneFile& file, std::size_t) -> double& { return file.scene.background.depth_mm; }, {1.0, 1e8},
      "distance ahead of the origin; not before any plate"));
  for (SceneKey& key : texture_keys("background.texture", [](SceneFile&file, std::size_t) -> TextureParameters& {
         return file.scene.background.*&B::texture;
       })) {
    keys.push_back(std::move(key));
  }
}

void add_excitation_keys(std::vector<SceneKey>& keys) {
  using E = ExcitationParameters;
  keys.push_back(scene_number(
      "excitation.rms_mm", "mm", excitation<&E::rms_mm>, {0.0, 1e4},
      "of the last body relative to the ground, by a weight of 1; scales ground and forces alike. 0 = at rest"));
  keys.push_back(scene_number(
      "excitation.base", "", excitation<&E::base>, {0.0, 1e6},
      "weight of the ground's motion: alone it moves the last body by base * rms_mm; 0 = the ground is static"));
  keys.push_back(scene_number("excitation.forces", "", excitation<&E::forces>, {0.0, 1e6},
                              "weight of independent forces on every body (wind, traffic): alone forces * rms_mm"));
  keys.push_back(scene_tuple("excitation.band_hz", "Hz", {excitation<&E::band_low_hz>, excitation<&E::band_high_hz>}, 2,
                             {0.01, 1e3}, "[low, high]: where the input is, white"));
  keys.push_back(scene_number("excitation.base_peaks[].frequency_hz", "Hz", peak<&E::Peak::frequency_hz>, {0.01, 1e3},
                              "where the ground itself resonates"));
  keys.push_back(scene_number("excitation.base_peaks[].damping_ratio", "", peak<&E::Peak::damping_ratio>, {1e-4, 1.0},
                              "width of that peak"));
  keys.push_back(scene_number("excitation.base_peaks[].gain", "", peak<&E::Peak::gain>, {0.0, 1e3},
                              "the amplitude there is 1 + gain"));
  keys.push_back(scene_whole("excitation.harmonics[].body", "", harmonic<&E::Harmonic::body>, {1, 64},
                             "that a machine shakes; 1 = the first after the ground"));
  keys.push_back(scene_number("excitation.harmonics[].frequency_hz", "Hz", harmonic<&E::Harmonic::frequency_hz>,
                              {0.01, 1e3}, "of the machine"));
  keys.push_back(scene_number("excitation.harmonics[].rms_mm", "mm", harmonic<&E::Harmonic::rms_mm>, {0.0, 1e4},
                              "of that body's response"));
}

const std::vector<SceneList>& scene_lists() {
  static const std::vector<SceneList> lists{
      {"plates",
       [](SceneFile& file, std::size_t n) {
         Plate plain;
         plain.texture.pitch_mm = 0.0;
         file.scene.plates.assign(n, plain);
       },
       [](const SceneFile& file) { return file.scene.plates.size(); }},
      {"excitation.base_peaks", [](SceneFile& file, std::size_t n) { file.scene.excitation.base_peaks.assign(n, {}); },
       [](const SceneFile& file) { return file.scene.excitation.base_peaks.size(); }},
      {"excitation.harmonics", [](SceneFile& file, std::size_t n) { file.scene.excitation.harmonics.assign(n, {}); },
       [](const SceneFile& file) { return file.scene.excitation.harmonics.size(); }}};
  return lists;
}

}  // namespace drivers
