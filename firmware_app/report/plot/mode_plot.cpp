#include "firmware_app/report/plot/mode_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace app {
namespace {

constexpr double kReach = 1.12;  // half range of the component axis: the largest component is 1
constexpr double kCapPx = 3.0;   // at the ends of a sigma bar

// Upright: the image's v runs down, so the axis along the structure is -v.
PlotPanel panel_of(SvgDocument& svg, const ModePlotSpec& spec, const ModeLayout& layout) {
  const PlotAxis component{-kReach, kReach, false, {}};
  const PlotAxis along = layout.upright ? PlotAxis{-spec.high_px, -spec.low_px, false, {}}
                                        : PlotAxis{spec.low_px, spec.high_px, false, {}};
  return {svg, spec.box, layout.upright ? component : along, layout.upright ? along : component};
}

class ModePlot {
 public:
  ModePlot(SvgDocument& svg, const ModePlotSpec& spec, const ModeLayout& layout, const core::Mode& mode)
      : svg_(svg), spec_(spec), layout_(layout), mode_(mode), panel_(panel_of(svg, spec, layout)) {}

  void draw() {
    draw_places();
    draw_component_axis();
    panel_.draw_frame();
    for (std::size_t line = 0; line < 2; ++line) draw_shape(line);
  }

 private:
  // A light line for every region, with its name where names do not overlap.
  void draw_places() {
    const Box& box = spec_.box;
    double last = -std::numeric_limits<double>::infinity();
    for (const ModePlace& place : layout_.every_place()) {
      if (layout_.upright) {
        const double y = panel_.y_px(-place.along_px);
        svg_.line(box.x, y, box.right(), y, "g");
        if (!spec_.with_names || y - last < 13.0) continue;
        svg_.text(box.x - 6.0, y + 4.0, place.name, Anchor::kEnd, "s");
        last = y;
      } else {
        const double x = panel_.x_px(place.along_px);
        svg_.line(x, box.y, x, box.bottom(), "g");
        const double half = text_width_px(place.name, kSmallTextPx) / 2.0;
        if (!spec_.with_names || x - half < last + 6.0) continue;
        svg_.text(x, box.bottom() + 15.0, place.name, Anchor::kMiddle, "s");
        last = x + half;
      }
    }
  }

  void draw_component_axis() {
    const Box& box = spec_.box;
    for (const int value : {-1, 0, 1}) {
      const std::string label = value < 0 ? "−1" : value == 0 ? "0" : "1";
      const char* css_class = value == 0 ? "z" : "g";
      if (layout_.upright) {
        const double x = panel_.x_px(value);
        svg_.line(x, box.y, x, box.bottom(), css_class);
        svg_.text(x, box.bottom() + 15.0, label, Anchor::kMiddle, "s");
      } else {
        const double y = panel_.y_px(value);
        svg_.line(box.x, y, box.right(), y, css_class);
        svg_.text(box.x - 5.0, y + 4.0, label, Anchor::kEnd, "s");
      }
    }
  }

  void draw_shape(std::size_t i_line) {
    const std::vector<ModePlace>& places = layout_.lines[i_line];
    std::vector<PlotPoint> line;
    for (const ModePlace& place : places) {
      const bool known = place.channel < mode_.shape.size();
      line.push_back(at(place, known ? mode_.shape[place.channel].real() : std::numeric_limits<double>::quiet_NaN()));
    }
    svg_.path(line, i_line == 0 ? "k0" : "k1 d1");
    const double radius = line.size() > 30 ? 2.0 : 3.0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (!std::isfinite(line[i].x) || !std::isfinite(line[i].y)) continue;
      draw_deviation(places[i], i_line);
      svg_.marker(line[i].x, line[i].y, radius, places[i].is_base ? Marker::kSquare : Marker::kDot, fill_class(i_line));
    }
  }

  // A bar of one standard deviation to both sides.
  void draw_deviation(const ModePlace& place, std::size_t i_line) {
    if (place.channel >= mode_.shape_std.size() || !std::isfinite(mode_.shape_std[place.channel])) return;
    const double middle = mode_.shape[place.channel].real(), deviation = mode_.shape_std[place.channel];
    const PlotPoint a = at(place, middle - deviation), b = at(place, middle + deviation);
    const double cap_x = layout_.upright ? 0.0 : kCapPx, cap_y = layout_.upright ? kCapPx : 0.0;
    const PlotPoint gap{std::numeric_limits<double>::quiet_NaN(), 0.0};
    const std::vector<PlotPoint> bar{a,
                                     b,
                                     gap,
                                     {a.x - cap_x, a.y - cap_y},
                                     {a.x + cap_x, a.y + cap_y},
                                     gap,
                                     {b.x - cap_x, b.y - cap_y},
                                     {b.x + cap_x, b.y + cap_y}};
    svg_.path(bar, fmt::format("k{}", i_line));
  }

  [[nodiscard]] PlotPoint at(const ModePlace& place, double value) const {
    const double inside = std::isfinite(value) ? std::clamp(value, -kReach, kReach) : value;
    return layout_.upright ? PlotPoint{panel_.x_px(inside), panel_.y_px(-place.along_px)}
                           : PlotPoint{panel_.x_px(place.along_px), panel_.y_px(inside)};
  }

  SvgDocument& svg_;
  const ModePlotSpec& spec_;
  const ModeLayout& layout_;
  const core::Mode& mode_;
  PlotPanel panel_;
};

}  // namespace

void draw_mode_plot(SvgDocument& svg, const ModePlotSpec& spec, const ModeLayout& layout, const core::Mode& mode) {
  ModePlot(svg, spec, layout, mode).draw();
}

}  // namespace app
