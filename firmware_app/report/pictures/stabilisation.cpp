#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "firmware_app/report/pictures/parts.h"
#include "firmware_app/report/plot/mode_labels.h"
#include "firmware_app/report/plot/spectrum_curves.h"
#include "firmware_app/report/plot/svg_plot.h"
#include "firmware_app/report/plot/verdict_marks.h"

namespace app {
namespace {

constexpr double kPolePx = 3.2;
constexpr std::size_t kMaxPoles = 1'500;  // most drawn: keeps the page below 2 MB; unassigned ones are dropped first
constexpr double kLoosePx = 1.6;          // radius of poles that belong to no listed mode

// The mode to whose line a pole belongs; null: to none.
const core::Mode* line_of(const core::ModalEstimate& estimate, const core::StabilisationPole& pole) {
  if (pole.i_line < 0) return nullptr;
  const auto i = static_cast<std::size_t>(pole.i_line);
  if (i < estimate.modes.size()) return &estimate.modes[i];
  const std::size_t k = i - estimate.modes.size();
  return k < estimate.rejected.size() ? &estimate.rejected[k] : nullptr;
}

// The spectrum of all channels over the panel's height, for comparison of frequencies.
void draw_spectrum(PlotPanel& panel, SvgDocument& svg, const PictureInputs& inputs, const PictureFormat& format) {
  if (!is_drawable(inputs.spectrum)) return;
  const std::vector<PlotPoint> points = decimated(total_density(*inputs.spectrum), curve_points(4, format));
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const PlotPoint& point : points) {
    if (std::isfinite(point.y)) low = std::min(low, point.y), high = std::max(high, point.y);
  }
  PlotPanel behind(svg, panel.box(), {0.0, inputs.estimate->rate_hz / 2.0, false, {}},
                   log_axis_around(low, high, 10, {}));
  behind.curve(points, "behind");
}

void draw_poles(SvgDocument& svg, const PlotPanel& panel, const core::ModalEstimate& estimate, double highest_hz) {
  // Unassigned poles first, modes last, so that modes lie on top.
  std::size_t n_drawn = 0;
  for (int layer = estimate.poles.size() > kMaxPoles ? 1 : 0; layer < 3; ++layer) {
    for (const core::StabilisationPole& pole : estimate.poles) {
      if (!(pole.apparent_hz >= 0.0 && pole.apparent_hz <= highest_hz)) continue;
      if (!std::isfinite(pole.frequency_hz + pole.damping_ratio + pole.mpc)) continue;
      const core::Mode* line = line_of(estimate, pole);
      const bool kept = line != nullptr && line->verdict == core::Verdict::kStructural;
      if (layer != (line == nullptr ? 0 : kept ? 2 : 1)) continue;
      if (++n_drawn > kMaxPoles) return;
      const double x = panel.x_px(pole.apparent_hz), y = panel.y_px(pole.order);
      const std::string facts = fmt::format("data-p=\"{} {:.4g} {:.3g} {:.3g} {}\"", pole.order, pole.frequency_hz,
                                            100.0 * pole.damping_ratio, pole.mpc, kept ? 1 : 0);
      if (line == nullptr) {
        svg.marker(x, y, kLoosePx, Marker::kDot, "m7", facts);
      } else {
        const VerdictMark& mark = mark_of(line->verdict);
        svg.marker(x, y, kPolePx, mark.marker, mark.marker_class, facts);
      }
    }
  }
}

}  // namespace

std::string stabilisation_svg(const PictureInputs& inputs, const PictureFormat& format) {
  if (inputs.estimate == nullptr || inputs.estimate->poles.empty() || !(inputs.estimate->rate_hz > 0.0)) return {};
  const core::ModalEstimate& estimate = *inputs.estimate;
  const auto [lowest, highest] = std::minmax_element(estimate.poles.begin(), estimate.poles.end(),
                                                     [](const auto& a, const auto& b) { return a.order < b.order; });
  const double highest_hz = estimate.rate_hz / 2.0;
  Box box{62.0, 0.0, format.width_px - 62.0 - 14.0, is_narrow(format) ? 300.0 : 400.0};
  const ModeLabels labels(&estimate, highest_hz, box.x, box.width, format);
  box.y = 8.0 + labels.height_px();
  SvgDocument svg(format.width_px, box.bottom() + 46.0, "Stabilisation diagram: poles over model order",
                  format.on_page);
  PlotPanel panel(svg, box, {0.0, highest_hz, false, "apparent frequency, Hz"},
                  {lowest->order - 1.0, highest->order + 1.0, false, "model order"});
  panel.begin_readout("poles");
  panel.draw_x_axis(true, is_narrow(format) ? 6 : 14);
  panel.draw_y_axis(true, 8);
  draw_spectrum(panel, svg, inputs, format);
  panel.draw_frame();
  labels.draw(svg, panel);
  draw_poles(svg, panel, estimate, highest_hz);
  panel.end_readout();
  return svg.text_of();
}

}  // namespace app
