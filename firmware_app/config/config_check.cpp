#include "firmware_app/config/config_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "drivers/camera/network/stream_address.h"
#include "drivers/storage/text_file.h"

namespace app {
namespace {

class Checker {
 public:
  Checker(const AppConfig& config, const KeyOrigins& origins, const std::string& file_name)
      : config_(config), origins_(origins), file_name_(file_name) {}

  void check() const {
    check_camera();
    check_record();
    check_regions();
    check_references();
    check_scale();
    check_calibration();
    check_depths();
    if (is_written("closure.delay_s") && config_.closure.delay_s > config_.closure.period_s) {
      refuse("closure.delay_s", fmt::format("{:g}", config_.closure.delay_s),
             fmt::format("0 .. {:g} (closure.period_s)", config_.closure.period_s), "write a smaller number");
    }
    if (config_.tracking.min_points > config_.tracking.points_per_region) {
      refuse("tracking.min_points", std::to_string(config_.tracking.min_points),
             fmt::format("1 .. {} (tracking.points_per_region)", config_.tracking.points_per_region),
             "write a smaller number");
    }
  }

 private:
  [[nodiscard]] bool is_written(const std::string& key) const { return origins_.contains(key); }

  [[noreturn]] void refuse(const std::string& key, const std::string& value, const std::string& allowed,
                           const std::string& remedy) const {
    const auto origin = origins_.find(key);
    throw ConfigError(fmt::format("{}: {}: {} is refused: allowed {}; {}",
                                  origin == origins_.end() ? file_name_ : origin->second, key, value, allowed, remedy));
  }
  void require(const std::string& key, const std::string& because, const std::string& remedy) const {
    if (!is_written(key)) refuse(key, "nothing", because, remedy);
  }

  void check_camera() const {
    if (config_.camera.driver == drivers::CameraKind::kFile && config_.camera.source.empty()) {
      refuse("camera.source", is_written("camera.source") ? "an empty text" : "nothing", "a video or image folder",
             "set it, or use `driver: synthetic` to try without a camera");
    }
    if (config_.camera.driver == drivers::CameraKind::kStream) check_stream();
    check_attitude();
    check_aircraft();
  }

  void check_stream() const {
    try {
      (void)drivers::stream_address(config_.camera.source, config_.camera.transport);
    } catch (const std::invalid_argument& error) {
      const auto origin = origins_.find("camera.source");
      throw ConfigError(fmt::format("{}: {}", origin == origins_.end() ? file_name_ : origin->second, error.what()));
    }
  }

  void check_attitude() const {
    const std::string key = config_.camera.attitude_file.empty() ? "camera.attitude_channel" : "camera.attitude_file";
    const std::string& value =
        config_.camera.attitude_file.empty() ? config_.camera.attitude_channel : config_.camera.attitude_file;
    if (value.empty()) return;
    if (!config_.camera.attitude_file.empty() && !config_.camera.attitude_channel.empty())
      refuse("camera.attitude_channel", config_.camera.attitude_channel, "a file or a channel, not both", "remove one");
    const bool is_distance_only = config_.scale.following == core::CameraFollowing::kDistance;
    if (is_distance_only || !config_.scale.adaptive || config_.method == Method::kPaper) {
      refuse(key, value, "if the camera's rotation is estimated",
             "remove `scale: {only: true}`, `scale: {adaptive: false}` or `method: paper`");
    }
    if (config_.calibration.file.empty() && !(config_.calibration.fx > 0.0))
      refuse(key, value, "if a focal length is known", "add a calibration, which converts angles to pixels");
    if (config_.camera.attitude_file.empty() && config_.telemetry.lcm_url.empty())
      refuse(key, value, "if telemetry.lcm_url names a network", "set telemetry.lcm_url");
  }

  void check_aircraft() const {
    const CameraConfig& camera = config_.camera;
    if (camera.aircraft_channel.empty()) return;
    const auto refuse_it = [&](const std::string& limit, const std::string& remedy) {
      refuse("camera.aircraft_channel", camera.aircraft_channel, limit, remedy);
    };
    if (!camera.motors_file.empty()) refuse_it("a channel or camera.motors_file, not both", "remove one");
    if (config_.telemetry.lcm_url.empty())
      refuse_it("only if telemetry.lcm_url names a network", "set telemetry.lcm_url");
    if (camera.aircraft_channel == camera.attitude_channel)
      refuse_it("a channel other than camera.attitude_channel", "name each as `hovermodal mavlink` does");
  }

  void check_record() const {
    if (config_.record.directory.empty() || config_.record.quota_mb >= 2 * config_.record.file_mb) return;
    refuse("record.quota_mb", std::to_string(config_.record.quota_mb),
           fmt::format("{} or more: two files of record.file_mb", 2 * config_.record.file_mb),
           "raise it, or lower record.file_mb");
  }

  void check_regions() const {
    if (config_.regions.empty()) {
      refuse("regions", "no region", "1 or more", "add e.g. `regions: [{name: roof, rect: [100, 100, 200, 80]}]`");
    }
    for (std::size_t i = 0; i < config_.regions.size(); ++i) {
      require(fmt::format("regions.{}.name", i), "1 .. 32 letters, digits, _ - .", "give every region a name");
      require(fmt::format("regions.{}.rect", i), "[x, y, w, h]", "give every region a rectangle");
    }
    // Channels get their names from regions: "a" with both axes gives a.u and a.v, which no other region may be called.
    std::vector<std::string> taken;
    for (std::size_t i = 0; i < config_.regions.size(); ++i) {
      const core::Region& region = config_.regions[i];
      std::vector<std::string> names = channel_names(region);
      if (region.both_axes) names.push_back(region.name);
      for (std::string& name : names) {
        if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
          refuse(fmt::format("regions.{}.name", i), region.name, "names that no other region or channel has",
                 fmt::format("`{}` is already used; rename one", name));
        }
        taken.push_back(std::move(name));
      }
    }
    const auto measured = [](const core::Region& region) { return core::makes_channel(region.role); };
    if (std::none_of(config_.regions.begin(), config_.regions.end(), measured)) {
      refuse("regions", "only static regions", "1 or more regions with role structure or base",
             "declare the parts that vibrate");
    }
  }

  [[nodiscard]] static std::vector<std::string> channel_names(const core::Region& region) {
    if (!region.both_axes) return {region.name};
    return {region.name + ".u", region.name + ".v"};
  }

  void check_references() const {
    std::vector<std::string> channels;
    for (const core::Region& region : config_.regions) {
      if (!core::makes_channel(region.role)) continue;
      for (std::string& name : channel_names(region)) channels.push_back(std::move(name));
    }
    for (const std::string& reference : config_.identification.references) {
      if (std::find(channels.begin(), channels.end(), reference) == channels.end()) {
        refuse("identification.references", reference, fmt::format("{}", fmt::join(channels, " | ")),
               "name channels, or write []");
      }
    }
  }

  void check_scale() const {
    const std::vector<std::string> keys{"scale.known_length_mm", "scale.from", "scale.to"};
    const bool any = std::any_of(keys.begin(), keys.end(), [&](const std::string& key) { return is_written(key); });
    for (const std::string& key : keys) {
      if (any)
        require(key, "known_length_mm, from and to together", "write all three, or none to get displacements in px");
    }
    if (any && config_.scale.from_px == config_.scale.to_px) {
      refuse("scale.to", fmt::format("[{}]", fmt::join(config_.scale.to_px, ", ")), "a point other than scale.from",
             "give the known length two different ends");
    }
    const ScaleConfig& scale = config_.scale;
    if (static_cast<int>(any) + static_cast<int>(!scale.lengths.empty()) + static_cast<int>(!scale.points.empty()) >
        1) {
      refuse(scale.points.empty() ? "scale.lengths" : "scale.points", "a second scale",
             "one of known_length_mm, lengths and points", "remove the others");
    }
    for (const auto& row : scale.lengths) require_two_ends("scale.lengths", row);
    for (std::size_t i = 0; i < config_.regions.size(); ++i) {
      const core::Region& r = config_.regions[i];
      if (r.length_mm > 0.0) {
        require_two_ends(fmt::format("regions.{}.length", i),
                         {r.length_from_px.u, r.length_from_px.v, r.length_to_px.u, r.length_to_px.v, r.length_mm});
      }
    }
    if (!scale.points.empty() && config_.calibration.file.empty() && config_.calibration.fx == 0.0) {
      refuse("scale.points", fmt::format("{} points", scale.points.size()), "with a calibration",
             "give calibration.file or fx fy cx cy (`hovermodal calibrate` makes it), or scale.lengths in their place");
    }
  }

  void require_two_ends(const std::string& key, const std::array<double, 5>& row) const {
    if (std::hypot(row[2] - row[0], row[3] - row[1]) >= 2.0) return;
    refuse(key, fmt::format("[{}]", fmt::join(row, ", ")), "ends 2 px or more apart",
           "give the length two different ends");
  }

  // A depth in metres is usable only together with the structure's depth: focal length times scale.
  void check_depths() const {
    for (std::size_t i = 0; i < config_.regions.size(); ++i) {
      const std::string key = fmt::format("regions.{}.depth_m", i);
      if (!(config_.regions[i].depth_m > 0.0)) continue;
      const std::string value = fmt::format("{}", config_.regions[i].depth_m);
      if (config_.regions[i].role != core::RegionRole::kBackground)
        refuse(key, value, "a region of role background", "remove it: the structure's distance follows from its scale");
      if (config_.calibration.fx <= 0.0 && config_.calibration.file.empty())
        refuse(key, value, "with a focal length", "set calibration.fx, fy, cx, cy or calibration.file, or remove it");
      if (!(config_.scale.known_length_mm > 0.0) && config_.scale.lengths.empty() && config_.scale.points.empty())
        refuse(key, value, "with a scale", "set scale.known_length_mm, from and to, or scale.points, or remove it");
    }
  }

  void check_calibration() const {
    const std::vector<std::string> inline_keys{"fx", "fy", "cx", "cy"};
    const auto written = [&](const std::string& name) { return is_written("calibration." + name); };
    const bool any =
        std::any_of(inline_keys.begin(), inline_keys.end(), written) || written("distortion") || written("model");
    if (any && !config_.calibration.file.empty()) {
      refuse("calibration.file", drivers::printable(config_.calibration.file), "a file, or fx fy cx cy, not both",
             "remove one of them");
    }
    for (const std::string& name : inline_keys) {
      if (any) require("calibration." + name, "fx, fy, cx and cy together", "write all four, or none");
    }
    const auto& k = config_.calibration.distortion;
    if (config_.calibration.model == core::LensModel::kEquidistant &&
        std::any_of(k.begin() + 4, k.end(), [](double value) { return value != 0.0; })) {
      refuse("calibration.distortion", fmt::format("[{}]", fmt::join(k, ", ")),
             "[k1, k2, k3, k4] with model equidistant", "remove the others, or write model: radtan");
    }
  }

  const AppConfig& config_;
  const KeyOrigins& origins_;
  const std::string& file_name_;
};

}  // namespace

void check_config(const AppConfig& config, const KeyOrigins& origins, const std::string& file_name) {
  Checker(config, origins, file_name).check();
}

}  // namespace app
