#include "tools/hovermodal/magnify/modal_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include "core/geometry/channel_layout.h"
#include "core/types/constants.h"
#include "drivers/storage/tracks_file.h"
#include "firmware_app/replay/run_folder.h"
#include "firmware_app/report/modal_json.h"

namespace tools {
namespace {

constexpr double kPatchPx =
    12.0;  // what a point is measured by moves with it: half of the largest patch, and a cell of the mesh
constexpr double kHalfBand = 4.0;        // in zeta f: holds 84 % of the power of a resonance under white noise
constexpr double kLeastBandLines = 2.0;  // and at least as many lines of the record's own resolution

using Complex = std::complex<double>;

// A channel's unit vector in the image.
struct Direction {
  std::string region;
  double u = 1.0, v = 0.0;
};

class MotionReader {
 public:
  MotionReader(const std::string& folder, int number)
      : folder_(folder), report_(app::read_modal_json((folder_ / "modal.json").string())), mode_(mode_of(number)) {
    if (mode_.shape_std.size() != mode_.shape.size()) {
      throw std::runtime_error(
          fmt::format("mode {}: its shape has no standard deviation (the record is shorter than two segments): nobody "
                      "knows whether this would magnify noise",
                      number));
    }
  }

  [[nodiscard]] ModalMotion read() {
    out_.frequency_hz = mode_.frequency_hz, out_.apparent_hz = mode_.apparent_hz;
    out_.frequency_std_hz = mode_.frequency_std_hz;
    place_regions();
    for (std::size_t c = 0; c < report_.channel_names.size(); ++c) add_channel(c);
    hold_what_is_noise();
    out_.amplitude_px = amplitude_px();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const core::Mode& mode_of(int number) const {
    const std::vector<core::Mode>& modes = report_.estimate.modes;
    if (number >= 1 && static_cast<std::size_t>(number) <= modes.size())
      return modes[static_cast<std::size_t>(number) - 1];
    throw std::invalid_argument(fmt::format("--mode {}: {} has {} modes", number, (folder_ / "modal.json").string(),
                                            modes.empty() ? "no" : std::to_string(modes.size())));
  }

  void place_regions() {
    const drivers::TracksFile tracks = drivers::read_tracks_csv((folder_ / "tracks.csv").string());
    out_.width_px = tracks.camera.width_px, out_.height_px = tracks.camera.height_px;
    out_.regions.resize(tracks.region_names.size());
    for (std::size_t r = 0; r < out_.regions.size(); ++r) {
      RegionMotion& region = out_.regions[r];
      region.name = tracks.region_names[r];
      region.is_static = true;
      region.left = region.top = 1e9, region.right = region.bottom = -1e9;
    }
    for (const core::TrackPoint& point : tracks.first.points) {
      RegionMotion& region = out_.regions.at(point.region);
      region.left = std::min(region.left, point.u_px - kPatchPx),
      region.top = std::min(region.top, point.v_px - kPatchPx);
      region.right = std::max(region.right, point.u_px + kPatchPx);
      region.bottom = std::max(region.bottom, point.v_px + kPatchPx);
    }
    std::erase_if(out_.regions, [](const RegionMotion& region) { return region.left > region.right; });
  }

  [[nodiscard]] Direction direction_of(const std::string& channel) const {
    for (const core::Region& region : report_.regions) {
      const double angle = region.axis_deg * core::kRadPerDeg;
      if (region.name == channel && !region.both_axes) return {channel, std::cos(angle), std::sin(angle)};
    }
    const bool along_v = channel.ends_with(".v");
    return {std::string(core::without_axis(channel)), along_v ? 0.0 : 1.0, along_v ? 1.0 : 0.0};
  }

  [[nodiscard]] bool takes_part(std::size_t c) const {
    return c < mode_.shape.size() && (c >= report_.estimate.channels.size() || report_.estimate.channels[c].takes_part);
  }

  void add_channel(std::size_t c) {
    const Direction direction = direction_of(report_.channel_names[c]);
    const auto at = std::find_if(out_.regions.begin(), out_.regions.end(),
                                 [&](const RegionMotion& region) { return region.name == direction.region; });
    if (at == out_.regions.end()) return;  // never seen in the first frame
    at->is_static = false;
    if (!takes_part(c)) {
      at->held = "its component is not known";
      return;
    }
    at->shape_u += mode_.shape[c] * direction.u, at->shape_v += mode_.shape[c] * direction.v;
    at->sigma_u = core::length(at->sigma_u, mode_.shape_std[c] * direction.u);
    at->sigma_v = core::length(at->sigma_v, mode_.shape_std[c] * direction.v);
  }

  void hold_what_is_noise() {
    bool any = false;
    for (RegionMotion& region : out_.regions) {
      const double size = std::sqrt(std::norm(region.shape_u) + std::norm(region.shape_v));
      const double sigma = core::length(region.sigma_u, region.sigma_v);
      const bool is_known = !region.is_static && region.held.empty();
      if (is_known && !(size >= kLeastSigmas * sigma)) region.held = "this would magnify noise";
      any = any || (is_known && region.held.empty() && size > 0.0);
    }
    if (!any) {
      throw std::runtime_error(fmt::format(
          "no region of this mode moves by {:g} standard deviations or more: this would magnify noise", kLeastSigmas));
    }
  }

  // The record's part within the mode's band, along the mode's shape: sum over the band's lines of the discrete Fourier
  // transform. Lost samples count as zero.
  [[nodiscard]] double amplitude_px() {
    const app::MeasuredRows rows = app::rows_of_displacements((folder_ / "displacements.csv").string(), {});
    const app::ChannelSeries series = app::on_grid(rows);
    const std::size_t n = series.value.empty() ? 0 : series.value.front().size();
    if (n == 0 || !(series.rate_hz > 0.0)) throw std::runtime_error("displacements.csv has no samples");
    out_.rate_hz = series.rate_hz;
    const double line_hz = series.rate_hz / static_cast<double>(n);
    const double half_hz = std::max(kHalfBand * mode_.damping_ratio * mode_.frequency_hz, kLeastBandLines * line_hz);
    const auto low = std::max<long>(1, std::lround((mode_.apparent_hz - half_hz) / line_hz));
    const auto high = std::min<long>(static_cast<long>(n) / 2, std::lround((mode_.apparent_hz + half_hz) / line_hz));
    double power = 0.0;
    for (long k = low; k <= high; ++k) power += 2.0 * std::norm(modal_line(series, k, n));
    double px = std::sqrt(2.0 * power);
    if (series.unit == "mm") px /= first_scale(rows.scale_mm_per_px);
    return px;
  }

  // Least squares of the shape in one line. A channel is seen later than the frame begins, by its row delay.
  [[nodiscard]] Complex modal_line(const app::ChannelSeries& series, long k, std::size_t n) const {
    Complex along = 0.0;
    double squares = 0.0;
    const double hz = static_cast<double>(k) * series.rate_hz / static_cast<double>(n);
    for (std::size_t c = 0; c < series.value.size(); ++c) {
      const auto at = std::find(report_.channel_names.begin(), report_.channel_names.end(), series.channels[c].name);
      const auto i = static_cast<std::size_t>(at - report_.channel_names.begin());
      if (!takes_part(i)) continue;
      Complex sum = 0.0;
      const Complex step = std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
      Complex turn = 1.0;
      for (const double value : series.value[c]) {
        if (std::isfinite(value)) sum += value * turn;
        turn *= step;
      }
      const bool is_folded = mode_.fold_n.value_or(0) != 0;
      if (!is_folded) sum *= std::polar(1.0, -2.0 * std::numbers::pi * hz * series.channels[c].row_delay_s);
      along += std::conj(mode_.shape[i]) * sum / static_cast<double>(n);
      squares += std::norm(mode_.shape[i]);
    }
    return squares > 0.0 ? along / squares : 0.0;
  }

  [[nodiscard]] static double first_scale(const std::vector<double>& scale) {
    const auto known = std::find_if(scale.begin(), scale.end(), [](double one) { return one > 0.0; });
    if (known == scale.end()) throw std::runtime_error("displacements.csv is in mm and states no scale_mm_per_px");
    return *known;
  }

  std::filesystem::path folder_;
  app::ModalReport report_;
  const core::Mode& mode_;
  ModalMotion out_;
};

}  // namespace

ModalMotion modal_motion(const std::string& folder, int number) { return MotionReader(folder, number).read(); }

}  // namespace tools
