#include <algorithm>
#include <array>
#include <utility>

#include "firmware_app/config/config_sections.h"

namespace app {
namespace {

using A = AppConfig;
constexpr double kMaxLengthMm = 1e9;
constexpr NumberRange kPixel{0, kMaxImagePx};
constexpr NumberRange kLength{1e-6, kMaxLengthMm};

// Rows with a fixed number of columns, as stored in the configuration.
template <std::size_t N>
ConfigKey table_key(std::string path, std::string unit, std::vector<std::array<double, N>> ScaleConfig::*member,
                    std::array<NumberRange, N> ranges, std::size_t n_min, std::string allowed, std::string meaning) {
  NumberRows rows;
  rows.ranges.assign(ranges.begin(), ranges.end());
  rows.n_min = n_min;
  rows.n_max = 1000;
  rows.put = [member](AppConfig& config, const std::vector<std::vector<double>>& values) {
    auto& out = config.scale.*member;
    out.assign(values.size(), {});
    for (std::size_t i = 0; i < values.size(); ++i) std::copy_n(values[i].begin(), N, out[i].begin());
  };
  rows.get = [member](AppConfig& config) {
    std::vector<std::vector<double>> values;
    for (const auto& row : config.scale.*member) values.emplace_back(row.begin(), row.end());
    return values;
  };
  return with_default(
      rows_key(std::move(path), std::move(unit), std::move(rows), std::move(allowed), std::move(meaning)), "none");
}

ConfigKey lengths_key() {
  return table_key<5>("scale.lengths", "px, mm", &ScaleConfig::lengths, {kPixel, kPixel, kPixel, kPixel, kLength}, 1,
                      "[[u1, v1, u2, v2, mm], ...], pixels 0 .. 100000",
                      "several known lengths in the first image, in place of known_length_mm; one scale is fitted "
                      "by least squares");
}

ConfigKey points_key() {
  constexpr NumberRange kPlace{-kMaxLengthMm, kMaxLengthMm};
  return table_key<4>("scale.points", "px, mm", &ScaleConfig::points, {kPixel, kPixel, kPlace, kPlace}, 4,
                      "[[u, v, x_mm, y_mm], ...], 4 or more, not on one line",
                      "points of the structure's plane with their coordinates in that plane; gives the pose of the "
                      "plane and a scale for every region; needs a calibration");
}

}  // namespace

void add_region_length_key(std::vector<ConfigKey>& keys) {
  NumberList list;
  list.ranges = {kPixel, kPixel, kPixel, kPixel, kLength};
  list.n_min = 5;
  list.put = [](AppConfig& config, std::size_t i, const std::vector<double>& v) {
    core::Region& region = config.regions[i];
    region.length_from_px = {v[0], v[1]}, region.length_to_px = {v[2], v[3]}, region.length_mm = v[4];
  };
  list.get = [](AppConfig& config, std::size_t i) {
    const core::Region& r = config.regions[i];
    return std::vector<double>{r.length_from_px.u, r.length_from_px.v, r.length_to_px.u, r.length_to_px.v, r.length_mm};
  };
  keys.push_back(with_default(
      numbers_key("regions[].length", "px, mm", std::move(list), "[u1, v1, u2, v2, mm], pixels 0 .. 100000",
                  "a known length at this region in the first image; gives the region its own scale"),
      "none: the common scale"));
}

void add_scale_keys(std::vector<ConfigKey>& keys) {
  using C = ScaleConfig;
  keys.push_back(with_default(number_key("scale.known_length_mm", "mm", at(&A::scale, &C::known_length_mm), {1e-6, 1e9},
                                         "true distance between the points `from` and `to`"),
                              "none: displacements in px"));
  keys.push_back(with_default(pair_key("scale.from", "px", at(&A::scale, &C::from_px), {0, kMaxImagePx},
                                       "first end of the known length in the first image"),
                              "none"));
  keys.push_back(with_default(pair_key("scale.to", "px", at(&A::scale, &C::to_px), {0, kMaxImagePx},
                                       "second end of the known length in the first image"),
                              "none"));
  keys.push_back(lengths_key());
  keys.push_back(points_key());
  keys.push_back(number_key("scale.point_sigma_px", "px", at(&A::scale, &C::point_sigma_px), {0.01, 100},
                            "standard deviation of the pixel coordinates in `lengths`, `points` and regions' lengths"));
  keys.push_back(
      number_key("scale.max_obliqueness_deg", "degrees", at(&A::scale, &C::max_obliqueness_deg), {0, 80},
                 "largest angle between the structure's face and the image plane that you cannot exclude; the "
                 "report states its effect on the scale"));
  keys.push_back(switch_key("scale.adaptive", at(&A::scale, &C::adaptive),
                            "estimate the camera's distance (and motion, see scale.only) in every frame; false: the "
                            "camera is fixed (tripod)"));
  keys.push_back(choice_key<core::CameraFollowing>(
      "scale.only", at(&A::scale, &C::following),
      {{"true", core::CameraFollowing::kDistance},
       {"false", core::CameraFollowing::kWhole},
       {"auto", core::CameraFollowing::kSlow}},
      "true: estimate only the camera's distance; false: also its rotation and translation, if a focal length "
      "is known and a static region is in view (role background or ground), which adds that region's noise; "
      "auto: the rotation slower than 1 Hz; what is left is taken out of the modes as the static region measures it "
      "(spectrum.witness)"));
}

}  // namespace app
