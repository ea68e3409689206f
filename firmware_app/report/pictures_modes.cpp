#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "firmware_app/report/pictures_parts.h"
#include "firmware_app/report/svg_plot.h"

namespace app {
namespace {

constexpr std::size_t kMaxModes = 28;
constexpr std::size_t kMaxMarkers = 2'000;  // of all modes together: keeps the file below 500 kB
constexpr std::size_t kMaxNameCharacters = 16;
constexpr double kPanelTitlePx = 58.0;  // three lines over a panel
constexpr double kReach = 1.12;         // of the component axis: the largest component is 1

// One channel's place in every panel.
struct Place {
  std::size_t channel = 0;
  double along_px = 0.0;  // place of the region's centre in the image, along the structure
  std::string name;
  bool is_base = false;
};

// The structure's line in the image. Regions with two axes make two lines: u and v.
struct Layout {
  bool upright = true;  // spread over v more than over u
  std::vector<Place> lines[2];
  double low_px = std::numeric_limits<double>::infinity(), high_px = -std::numeric_limits<double>::infinity();
};

Layout layout_of(const PictureInputs& inputs) {
  std::vector<double> u, v;
  for (std::size_t i = 0; i < inputs.channels.size(); ++i) {
    const std::size_t r = inputs.channels[i].region;
    const bool known = r < inputs.regions.size();
    const double nth = static_cast<double>(i);
    u.push_back(known ? inputs.regions[r].u_px + inputs.regions[r].width_px / 2.0 : 0.0);
    v.push_back(known ? inputs.regions[r].v_px + inputs.regions[r].height_px / 2.0 : nth);
  }
  const auto spread = [](const std::vector<double>& x) {
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    return *high - *low;
  };
  Layout out;
  out.upright = u.empty() || spread(v) >= spread(u);
  for (std::size_t i = 0; i < inputs.channels.size(); ++i) {
    const core::ChannelInfo& channel = inputs.channels[i];
    const bool both = channel.region < inputs.regions.size() && inputs.regions[channel.region].both_axes;
    const double along = out.upright ? v[i] : u[i];
    const std::string name = both ? inputs.regions[channel.region].name : channel.name;
    const bool second = both && std::abs(channel.direction_v) > std::abs(channel.direction_u);
    out.lines[second ? 1 : 0].push_back({i, along, shortened(name, kMaxNameCharacters), channel.is_base});
    out.low_px = std::min(out.low_px, along), out.high_px = std::max(out.high_px, along);
  }
  for (auto& line : out.lines) {
    std::stable_sort(line.begin(), line.end(), [](const Place& a, const Place& b) { return a.along_px < b.along_px; });
  }
  const double air = std::max(1.0, 0.06 * (out.high_px - out.low_px));
  out.low_px -= air, out.high_px += air;
  return out;
}

class ModesPicture {
 public:
  ModesPicture(const std::vector<core::Mode>& modes, const Layout& layout) : modes_(modes), layout_(layout) {
    const std::size_t n_channels = std::max<std::size_t>(1, layout.lines[0].size() + layout.lines[1].size());
    n_shown_ = std::min({modes.size(), kMaxModes, std::max<std::size_t>(1, kMaxMarkers / n_channels)});
    for (const auto& line : layout.lines) {
      for (const Place& place : line) names_px_ = std::max(names_px_, text_width_px(place.name, kSmallTextPx) + 24.0);
    }
    const std::size_t most = layout.upright ? 6 : 3;
    n_columns_ = std::min(n_shown_, most);
    panel_width_ = layout.upright ? 134.0 : 280.0;
    panel_height_ = layout.upright ? 300.0 : 120.0;
    if (!layout.upright) names_px_ = 46.0;
  }

  [[nodiscard]] std::string draw() const {
    const std::size_t n_rows = (n_shown_ + n_columns_ - 1) / n_columns_;
    const double width = std::max(420.0, names_px_ + static_cast<double>(n_columns_) * column_step() + 4.0);
    SvgDocument svg(width, 44.0 + static_cast<double>(n_rows) * row_step(), "Mode shapes");
    svg.text(14.0, 24.0, "Mode shapes", Anchor::kStart, "h");
    const bool two = !layout_.lines[0].empty() && !layout_.lines[1].empty();
    if (two) svg.text(130.0, 24.0, "solid: along u, dashed: along v", Anchor::kStart, "s q");
    if (n_shown_ < modes_.size()) {
      svg.text(width - 14.0, 24.0, fmt::format("and {} more", modes_.size() - n_shown_), Anchor::kEnd, "t q");
    }
    for (std::size_t i = 0; i < n_shown_; ++i) draw_mode(svg, i);
    return svg.text_of();
  }

 private:
  [[nodiscard]] double column_step() const noexcept { return panel_width_ + (layout_.upright ? 18.0 : 36.0); }
  [[nodiscard]] double row_step() const noexcept {
    return kPanelTitlePx + panel_height_ + (layout_.upright ? 30.0 : 44.0);
  }

  void draw_mode(SvgDocument& svg, std::size_t i) const {
    const core::Mode& mode = modes_[i];
    const std::size_t i_column = i % n_columns_, i_row = i / n_columns_;
    const Box box{names_px_ + static_cast<double>(i_column) * column_step(),
                  44.0 + kPanelTitlePx + static_cast<double>(i_row) * row_step(), panel_width_, panel_height_};
    draw_title(svg, box, mode);
    // Upright: the image's v runs down, so the axis is -v.
    const PlotAxis component{-kReach, kReach, false, {}};
    const PlotAxis along = layout_.upright ? PlotAxis{-layout_.high_px, -layout_.low_px, false, {}}
                                           : PlotAxis{layout_.low_px, layout_.high_px, false, {}};
    PlotPanel panel(svg, box, layout_.upright ? component : along, layout_.upright ? along : component);
    draw_grid(svg, panel, i_column == 0);
    panel.draw_frame();
    for (std::size_t line = 0; line < 2; ++line) draw_shape(svg, panel, mode, line);
  }

  static void draw_title(SvgDocument& svg, const Box& box, const core::Mode& mode) {
    const double x = box.x + box.width / 2.0;
    std::string frequency = four_digits_text(mode.frequency_hz);
    if (mode.frequency_std_hz) frequency += " ± " + decimals_text(*mode.frequency_std_hz, 3);
    std::string damping = "damping " + decimals_text(100.0 * mode.damping_ratio, 2);
    if (mode.damping_std) damping += " ± " + decimals_text(100.0 * *mode.damping_std, 2);
    svg.text(x, box.y - 38.0, frequency + " Hz", Anchor::kMiddle);
    svg.text(x, box.y - 23.0, damping + " %", Anchor::kMiddle, "s");
    std::string quality = "MPC " + decimals_text(mode.mpc, 3);
    if (is_folded(mode)) quality += fmt::format(", seen at {} Hz", four_digits_text(mode.apparent_hz));
    svg.text(x, box.y - 9.0, quality, Anchor::kMiddle, "s");
  }

  // A light line for every region, with its name where names do not touch.
  void draw_grid(SvgDocument& svg, const PlotPanel& panel, bool first_column) const {
    const Box& box = panel.box();
    double last = -std::numeric_limits<double>::infinity();
    for (const Place& place : every_place()) {
      const double at = layout_.upright ? panel.y_px(-place.along_px) : panel.x_px(place.along_px);
      if (layout_.upright) {
        svg.line(box.x, at, box.right(), at, "g");
        if (first_column && at - last >= 11.0) {
          svg.text(box.x - 6.0, at + 3.5, place.name, Anchor::kEnd, "s");
          last = at;
        }
      } else {
        svg.line(at, box.y, at, box.bottom(), "g");
        const double half = text_width_px(place.name, kSmallTextPx) / 2.0;
        if (at - half < last + 6.0) continue;
        svg.text(at, box.bottom() + 14.0, place.name, Anchor::kMiddle, "s");
        last = at + half;
      }
    }
    for (const int value : {-1, 0, 1}) {
      const std::string label = value < 0 ? "−1" : value == 0 ? "0" : "1";
      if (layout_.upright) {
        svg.line(panel.x_px(value), box.y, panel.x_px(value), box.bottom(), value == 0 ? "z" : "g");
        svg.text(panel.x_px(value), box.bottom() + 14.0, label, Anchor::kMiddle, "s");
      } else {
        svg.line(box.x, panel.y_px(value), box.right(), panel.y_px(value), value == 0 ? "z" : "g");
        svg.text(box.x - 5.0, panel.y_px(value) + 3.5, label, Anchor::kEnd, "s");
      }
    }
  }

  [[nodiscard]] std::vector<Place> every_place() const {
    std::vector<Place> out = layout_.lines[0];
    for (const Place& place : layout_.lines[1]) {
      const bool there =
          std::any_of(out.begin(), out.end(), [&](const Place& other) { return other.along_px == place.along_px; });
      if (!there) out.push_back(place);
    }
    std::stable_sort(out.begin(), out.end(), [](const Place& a, const Place& b) { return a.along_px < b.along_px; });
    return out;
  }

  void draw_shape(SvgDocument& svg, PlotPanel& panel, const core::Mode& mode, std::size_t i_line) const {
    std::vector<PlotPoint> line;
    for (const Place& place : layout_.lines[i_line]) {
      const bool known = place.channel < mode.shape.size();
      const double value = known ? mode.shape[place.channel].real() : std::numeric_limits<double>::quiet_NaN();
      line.push_back(at(panel, place, value));
    }
    svg.path(line, i_line == 0 ? "k0" : "k1 d1");
    const double radius = line.size() > 30 ? 2.0 : 3.0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (!std::isfinite(line[i].x) || !std::isfinite(line[i].y)) continue;
      draw_deviation(svg, panel, mode, layout_.lines[i_line][i], i_line);
      if (layout_.lines[i_line][i].is_base) {
        svg.rect({line[i].x - radius, line[i].y - radius, 2.0 * radius, 2.0 * radius}, fill_class(i_line));
      } else {
        svg.circle(line[i].x, line[i].y, radius, fill_class(i_line));
      }
    }
  }

  [[nodiscard]] PlotPoint at(const PlotPanel& panel, const Place& place, double value) const {
    const double inside = std::isfinite(value) ? std::clamp(value, -kReach, kReach) : value;
    return layout_.upright ? PlotPoint{panel.x_px(inside), panel.y_px(-place.along_px)}
                           : PlotPoint{panel.x_px(place.along_px), panel.y_px(inside)};
  }

  // A bar of one standard deviation to both sides.
  void draw_deviation(SvgDocument& svg, const PlotPanel& panel, const core::Mode& mode, const Place& place,
                      std::size_t i_line) const {
    if (place.channel >= mode.shape_std.size() || !std::isfinite(mode.shape_std[place.channel])) return;
    const double middle = mode.shape[place.channel].real(), deviation = mode.shape_std[place.channel];
    const PlotPoint a = at(panel, place, middle - deviation), b = at(panel, place, middle + deviation);
    svg.line(a.x, a.y, b.x, b.y, line_class(i_line));
  }

  const std::vector<core::Mode>& modes_;
  const Layout& layout_;
  std::size_t n_shown_ = 0, n_columns_ = 1;
  double names_px_ = 60.0, panel_width_ = 0.0, panel_height_ = 0.0;
};

std::string no_modes(const core::ModalEstimate& estimate) {
  SvgDocument svg(600.0, 120.0, "Mode shapes");
  svg.text(14.0, 24.0, "Mode shapes", Anchor::kStart, "h");
  svg.text(300.0, 64.0, "no modes", Anchor::kMiddle);
  if (estimate.status != "ok") svg.text(300.0, 84.0, shortened(estimate.status, 90), Anchor::kMiddle, "s q");
  return svg.text_of();
}

}  // namespace

std::string modes_svg(const PictureInputs& inputs) {
  if (inputs.estimate == nullptr || inputs.channels.empty()) return {};
  if (inputs.estimate->modes.empty()) return no_modes(*inputs.estimate);
  const Layout layout = layout_of(inputs);
  return ModesPicture(inputs.estimate->modes, layout).draw();
}

}  // namespace app
