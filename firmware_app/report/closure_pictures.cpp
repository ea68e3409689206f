#include "firmware_app/report/closure_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "firmware_app/report/plot/svg_plot.h"

namespace app {
namespace {

using core::closure::ResidualView;

constexpr double kPanelPx = 420.0, kLongestArrow_px = 46.0;

double longest(const ResidualView& view) {
  return view.pattern_px.size() > 0 ? view.pattern_px.rowwise().norm().maxCoeff() : 0.0;
}

void draw_field(SvgDocument& svg, const ResidualPair& pair, const ResidualView& view, const Box& box,
                const std::string& title, double arrow_per_px) {
  svg.text(box.x, box.y - 10.0, title);
  svg.rect(box, "x");
  const double scale = box.width / std::max(pair.width_px, 1);
  for (Eigen::Index j = 0; j < view.place_px.rows(); ++j) {
    const double x = box.x + scale * view.place_px(j, 0), y = box.y + scale * view.place_px(j, 1);
    const double dx = arrow_per_px * view.pattern_px(j, 0), dy = arrow_per_px * view.pattern_px(j, 1);
    svg.line(x, y, x + dx, y + dy, "k0");
    svg.circle(x, y, 1.6, "m0");
  }
}

std::vector<PlotPoint> spectrum_of(const ResidualView& view) {
  std::vector<PlotPoint> out;
  for (std::size_t i = 0; i < view.frequency_hz.size(); ++i)
    out.push_back(
        {view.frequency_hz[i], view.level_px[i] > 0.0 ? view.level_px[i] : std::numeric_limits<double>::quiet_NaN()});
  return out;
}

// Patterns that the model itself has removed are left out.
std::vector<PlotPoint> patterns_of(const ResidualView& view) {
  std::vector<PlotPoint> out;
  for (std::size_t i = 0; i < view.singular_px.size(); ++i) {
    if (view.singular_px[i] > 1e-3 * view.singular_px.front())
      out.push_back({static_cast<double>(i + 1), view.singular_px[i]});
  }
  return out;
}

void draw_pair(SvgDocument& svg, const Box& box, const PlotAxis& x, const std::string& y_label,
               const std::vector<PlotPoint>& before, const std::vector<PlotPoint>& after) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const auto* curve : {&before, &after}) {
    for (const PlotPoint& p : *curve) {
      if (std::isfinite(p.y)) low = std::min(low, p.y), high = std::max(high, p.y);
    }
  }
  PlotPanel panel(svg, box, x, log_axis_around(low, high, 5, y_label));
  panel.draw_x_axis(true, 6);
  panel.draw_y_axis(true);
  panel.curve(before, line_class(1));
  panel.curve(after, line_class(0));
  panel.draw_frame();
}

}  // namespace

std::string closure_field_svg(const ResidualPair& pair) {
  const double height = kPanelPx * pair.height_px / std::max(pair.width_px, 1);
  SvgDocument svg(2.0 * kPanelPx + 60.0, height + 90.0, "Residual over the image, before and after");
  const double most = std::max(longest(pair.before), longest(pair.after));
  const double arrow = most > 0.0 ? kLongestArrow_px / most : 0.0;
  svg.text(20.0, 24.0, fmt::format("Leading pattern of the residual; the longest arrow is {:.3g} px rms", most),
           Anchor::kStart, "h");
  draw_field(svg, pair, pair.before, {20.0, 66.0, kPanelPx, height},
             fmt::format("before: {:.3g} px rms", pair.before.singular_px.front()), arrow);
  draw_field(svg, pair, pair.after, {40.0 + kPanelPx, 66.0, kPanelPx, height},
             fmt::format("after: {:.3g} px rms", pair.after.singular_px.front()), arrow);
  return svg.text_of();
}

std::string closure_residual_svg(const ResidualPair& pair) {
  SvgDocument svg(2.0 * kPanelPx + 160.0, 380.0, "Spectrum and patterns of the residual, before and after");
  svg.text(70.0, 24.0, fmt::format("Residual; stated noise {:.3g} px a point and axis", pair.noise_px), Anchor::kStart,
           "h");
  const std::vector<LegendEntry> legend{{"before", line_class(1)}, {"after", line_class(0)}};
  draw_legend(svg, {kPanelPx - 30.0, 34.0, 120.0, 40.0}, legend);
  const double highest = pair.before.frequency_hz.empty() ? 1.0 : pair.before.frequency_hz.back();
  draw_pair(svg, {70.0, 76.0, kPanelPx - 20.0, 250.0}, {0.0, highest, false, "frequency, Hz"}, "px per root Hz",
            spectrum_of(pair.before), spectrum_of(pair.after));
  const double last = static_cast<double>(std::max<std::size_t>(patterns_of(pair.before).size(), 2));
  draw_pair(svg, {kPanelPx + 140.0, 76.0, kPanelPx - 20.0, 250.0}, {1.0, last, false, "pattern"}, "px rms",
            patterns_of(pair.before), patterns_of(pair.after));
  return svg.text_of();
}

}  // namespace app
