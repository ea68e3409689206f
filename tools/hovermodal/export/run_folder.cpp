#include "tools/hovermodal/export/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <stdexcept>

#include "core/geometry/channel_layout.h"
#include "core/types/constants.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/replay/run_folder.h"
#include "firmware_app/report/modal_json.h"
#include "tools/hovermodal/export/keyframe_places.h"
#include "tools/hovermodal/export/run_spectra.h"

namespace tools {
namespace {

namespace fs = std::filesystem;

class RunLoader {
 public:
  explicit RunLoader(const std::string& path) : folder_(folder_of(path)) {}

  [[nodiscard]] LoadedRun load() {
    report_ = app::read_modal_json((folder_ / "modal.json").string());
    out_.run.name = fs::absolute(folder_).lexically_normal().filename().string();
    if (out_.run.name.empty())
      out_.run.name = fs::absolute(folder_).lexically_normal().parent_path().filename().string();
    const fs::path displacements = folder_ / "displacements.csv";
    if (fs::exists(displacements)) {
      load_series(displacements.string());
    } else {
      add_channels(report_.channel_names, {});
      remark("no displacements.csv beside modal.json: modes only, without series, spectra and correlations");
    }
    place_nodes();
    draw_line();
    for (const core::Mode& mode : report_.estimate.modes) out_.run.modes.push_back(mode_of(mode));
    if (out_.run.modes.empty()) remark("modal.json has no modes" + why_none());
    return std::move(out_);
  }

 private:
  static fs::path folder_of(const std::string& path) {
    fs::path named(path);
    if (fs::is_regular_file(named)) return named.parent_path().empty() ? fs::path(".") : named.parent_path();
    if (!fs::is_directory(named))
      throw std::invalid_argument(path + ": no such folder; name the folder that --report of a run wrote");
    if (!fs::exists(named / "modal.json"))
      throw std::invalid_argument(path + ": no modal.json in it; name the folder that --report of a run wrote");
    return named;
  }

  void remark(const std::string& text) { out_.remarks.push_back(text); }
  [[nodiscard]] std::string why_none() const {
    return report_.estimate.status.empty() ? "" : ": " + report_.estimate.status;
  }

  void load_series(const std::string& path) {
    app::MeasuredRows rows = app::rows_of_displacements(path, {});
    std::vector<std::string> names;
    std::vector<double> delays;
    for (const core::ChannelInfo& channel : rows.series.channels)
      names.push_back(channel.name), delays.push_back(channel.row_delay_s);
    add_channels(names, delays);
    out_.run.unit = rows.series.unit.empty() ? "px" : rows.series.unit;
    out_.run.rate_hz = rows.series.rate_hz;
    out_.run.t_s = rows.times.t_s;
    out_.run.value = rows.series.value;
    scale_ = first_scale(rows.scale_mm_per_px);
    const double resolution_hz = report_.estimate.resolution_hz;
    const int segment = resolution_hz > 0.0 ? static_cast<int>(std::lround(rows.series.rate_hz / resolution_hz)) : 0;
    if (!names.empty()) add_spectra(app::on_grid(rows), segment, out_.run, out_.remarks);
  }

  // mm per px in the first frame; 1 if displacements are in px.
  [[nodiscard]] double first_scale(const std::vector<double>& scale) const {
    if (out_.run.unit == "px") return 1.0;
    const auto known = std::find_if(scale.begin(), scale.end(), [](double one) { return one > 0.0; });
    return known == scale.end() ? 1.0 : *known;
  }

  [[nodiscard]] const core::Region* region_named(const std::string& name) const {
    const auto found = std::find_if(report_.regions.begin(), report_.regions.end(),
                                    [&](const core::Region& region) { return region.name == name; });
    return found == report_.regions.end() ? nullptr : &*found;
  }

  // A channel is called as its region, or, of a region with both axes, REGION.u and REGION.v.
  void add_channels(const std::vector<std::string>& names, const std::vector<double>& delays) {
    for (std::size_t c = 0; c < names.size(); ++c) {
      drivers::ExchangeChannel channel;
      channel.name = names[c];
      channel.delay_s = c < delays.size() ? delays[c] : 0.0;
      std::string region_name = names[c];
      if (const core::Region* region = region_named(region_name)) {
        channel.direction_x = std::cos(region->axis_deg * core::kRadPerDeg);
        channel.direction_y = -std::sin(region->axis_deg * core::kRadPerDeg);
      } else if (names[c].ends_with(".u") || names[c].ends_with(".v")) {
        const std::string stem(core::without_axis(names[c]));
        if (region_named(stem) != nullptr) region_name = stem;
        const bool along_v = names[c].ends_with(".v");
        channel.direction_x = along_v ? 0.0 : 1.0;
        channel.direction_y = along_v ? -1.0 : 0.0;
      } else {
        n_without_axis_++;
      }
      channel.node = node_named(region_name);
      out_.run.channels.push_back(channel);
    }
    if (n_without_axis_ > 0)
      remark(fmt::format("modal.json states no axis of {} channels: they are written along x", n_without_axis_));
  }

  std::size_t node_named(const std::string& name) {
    std::vector<drivers::ExchangeNode>& nodes = out_.run.nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (nodes[n].name == name) return n;
    }
    nodes.push_back({name});
    return nodes.size() - 1;
  }

  void place_nodes() {
    const fs::path tracks = folder_ / "tracks.csv";
    std::map<std::string, ImagePlace> places;
    if (fs::exists(tracks)) places = keyframe_places(tracks.string());
    std::size_t n_unknown = 0;
    for (drivers::ExchangeNode& node : out_.run.nodes) {
      const auto place = places.find(node.name);
      if (place == places.end()) {
        node.y = -static_cast<double>(n_unknown++);
      } else {
        node.x = scale_ * place->second.u_px, node.y = -scale_ * place->second.v_px;
      }
    }
    if (n_unknown > 0) {
      remark(fmt::format("{}: {} of {} places are unknown and lie one below the other, a unit apart",
                         fs::exists(tracks) ? "tracks.csv lacks regions" : "no tracks.csv beside modal.json", n_unknown,
                         out_.run.nodes.size()));
    }
  }

  // Regions in the order along the longer side of the structure.
  void draw_line() {
    const std::vector<drivers::ExchangeNode>& nodes = out_.run.nodes;
    out_.run.line.resize(nodes.size());
    std::iota(out_.run.line.begin(), out_.run.line.end(), std::size_t{0});
    const auto by_x = [](const auto& a, const auto& b) { return a.x < b.x; };
    const auto by_y = [](const auto& a, const auto& b) { return a.y < b.y; };
    const auto [left, right] = std::minmax_element(nodes.begin(), nodes.end(), by_x);
    const auto [low, high] = std::minmax_element(nodes.begin(), nodes.end(), by_y);
    if (nodes.empty()) return;
    const bool is_tall = high->y - low->y >= right->x - left->x;
    std::stable_sort(out_.run.line.begin(), out_.run.line.end(), [&](std::size_t a, std::size_t b) {
      return is_tall ? nodes[a].y < nodes[b].y : nodes[a].x < nodes[b].x;
    });
  }

  [[nodiscard]] drivers::ExchangeMode mode_of(const core::Mode& mode) const {
    drivers::ExchangeMode out;
    out.frequency_hz = mode.frequency_hz;
    out.frequency_std_hz = mode.frequency_std_hz;
    out.damping_ratio = mode.damping_ratio;
    out.damping_std = mode.damping_std;
    out.mpc = mode.mpc;
    out.verdict = core::to_string(mode.verdict);
    for (const drivers::ExchangeChannel& channel : out_.run.channels) {
      const auto at = std::find(report_.channel_names.begin(), report_.channel_names.end(), channel.name);
      const auto c = static_cast<std::size_t>(at - report_.channel_names.begin());
      const bool known =
          c < mode.shape.size() && (c >= report_.estimate.channels.size() || report_.estimate.channels[c].takes_part);
      out.shape.push_back(known ? mode.shape[c] : std::complex<double>(core::kNan, core::kNan));
      if (!mode.shape_std.empty()) out.shape_std.push_back(known ? mode.shape_std[c] : core::kNan);
    }
    return out;
  }

  fs::path folder_;
  app::ModalReport report_;
  LoadedRun out_;
  double scale_ = 1.0;
  std::size_t n_without_axis_ = 0;
};

}  // namespace

LoadedRun load_run(const std::string& path) { return RunLoader(path).load(); }

}  // namespace tools
