#include "firmware_app/report/structure_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware_app/report/plot/svg_plot.h"

namespace app {
namespace {

constexpr double kPanelPx = 210.0, kShapePx = 190.0, kGapPx = 46.0, kTopOfPanelPx = 58.0;
constexpr std::size_t kPanelsInRow = 4, kMostRows = 60;

std::string mac_text(const ShapeComparison& mode) {
  if (!mode.mac_before || !mode.mac_after) return {};
  return fmt::format("MAC {:.4f} to {:.4f}", *mode.mac_before, *mode.mac_after);
}

PlotAxis shape_axis(const ShapeComparison& mode) {
  double low = 0.0, high = 0.0;
  for (std::size_t i = 0; i < mode.measured.size(); ++i) {
    low = std::min({low, mode.measured[i] - mode.sigma[i], mode.before[i], mode.after[i]});
    high = std::max({high, mode.measured[i] + mode.sigma[i], mode.before[i], mode.after[i]});
  }
  return axis_around(low, high, "component");
}

std::vector<PlotPoint> curve_of(const std::vector<double>& shape) {
  std::vector<PlotPoint> out;
  for (std::size_t i = 0; i < shape.size(); ++i) out.push_back({static_cast<double>(i) + 1.0, shape[i]});
  return out;
}

void draw_shape(SvgDocument& svg, const Box& box, const ShapeComparison& mode, bool with_label) {
  const auto n = static_cast<double>(mode.measured.size());
  PlotPanel panel(svg, box, {0.5, n + 0.5, false, "channel"}, shape_axis(mode));
  panel.draw_x_axis(true, std::min(static_cast<int>(n), 6));
  panel.draw_y_axis(with_label, 4);
  panel.draw_frame();
  svg.line(box.x, panel.y_px(0.0), box.right(), panel.y_px(0.0), "v");
  panel.curve(curve_of(mode.before), "k1", "stroke-dasharray=\"4 3\"");
  panel.curve(curve_of(mode.after), "k0");
  for (std::size_t i = 0; i < mode.measured.size(); ++i) {
    const double x = panel.x_px(static_cast<double>(i) + 1.0);
    svg.line(x, panel.y_px(mode.measured[i] + mode.sigma[i]), x, panel.y_px(mode.measured[i] - mode.sigma[i]), "k2");
    svg.marker(x, panel.y_px(mode.measured[i]), 4.0, Marker::kDot, "m2");
  }
  svg.text(box.x, box.y - 20.0, fmt::format("mode {}: {:.4g} Hz measured", mode.number, mode.measured_hz));
  svg.text(box.x, box.y - 6.0, mac_text(mode), Anchor::kStart, "s q");
}

}  // namespace

std::string structure_shapes_svg(const std::vector<ShapeComparison>& modes, const std::vector<std::string>& channels) {
  if (modes.empty() || modes.front().measured.empty()) return {};
  const std::size_t columns = std::min(modes.size(), kPanelsInRow), rows = (modes.size() + columns - 1) / columns;
  const double width = 60.0 + static_cast<double>(columns) * (kPanelPx + kGapPx);
  const double height = 90.0 + static_cast<double>(rows) * (kShapePx + kTopOfPanelPx + 34.0);
  SvgDocument svg(width, height, "Measured and computed shapes");
  svg.text(24.0, 24.0, "Shapes: measured (dots, one sigma), model before (dashed) and after (line)", Anchor::kStart,
           "h");
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const std::size_t column = i % columns, row = i / columns;
    const Box box{60.0 + static_cast<double>(column) * (kPanelPx + kGapPx),
                  36.0 + kTopOfPanelPx + static_cast<double>(row) * (kShapePx + kTopOfPanelPx + 34.0), kPanelPx,
                  kShapePx};
    draw_shape(svg, box, modes[i], column == 0);
  }
  std::string names = "channels:";
  for (std::size_t i = 0; i < channels.size(); ++i) names += fmt::format(" {} {}", i + 1, channels[i]);
  svg.text(24.0, height - 16.0, shortened(names, static_cast<std::size_t>(width / 7.0)), Anchor::kStart, "s q");
  return svg.text_of();
}

std::string structure_places_svg(const std::string& effect, const std::vector<SoughtPlace>& places) {
  if (places.empty()) return {};
  const std::size_t n = std::min(places.size(), kMostRows);
  const double high = std::clamp(420.0 / static_cast<double>(n), 18.0, 60.0);
  const double height = 86.0 + static_cast<double>(n) * high + (places.size() > n ? 20.0 : 0.0);
  SvgDocument svg(760.0, height, "Where the effect was found");
  svg.text(24.0, 24.0, fmt::format("Where: {}", effect), Anchor::kStart, "h");
  svg.text(24.0, 44.0,
           "filled: found here; ringed: the modes do not distinguish it (95 %); number: chi-square over the best place",
           Anchor::kStart, "s q");
  for (std::size_t i = 0; i < n; ++i) {
    const SoughtPlace& place = places[i];
    const Box box{60.0, 62.0 + static_cast<double>(n - 1 - i) * high, 70.0, high - 3.0};
    const double middle = box.y + 0.5 * box.height;
    if (place.is_found) svg.rect(box, "m1");
    svg.rect(box, "x");
    if (place.is_indistinguishable) svg.marker(box.x - 16.0, middle, 5.0, Marker::kRing, "k1 n");
    svg.text(box.right() + 16.0, middle + 4.0,
             std::isfinite(place.excess_chi2) ? fmt::format("{:.1f}", place.excess_chi2) : "no fit", Anchor::kStart,
             "s q");
    svg.text(box.right() + 90.0, middle + 4.0, shortened(place.name, 70), Anchor::kStart, place.is_found ? "t" : "t q");
  }
  if (places.size() > n)
    svg.text(60.0, height - 10.0, fmt::format("{} more places are not drawn", places.size() - n), Anchor::kStart,
             "s q");
  return svg.text_of();
}

std::string structure_posterior_svg(const std::vector<FittedParameter>& parameters) {
  constexpr double kRowPx = 26.0;
  constexpr Box kColumn{250.0, 62.0, 280.0, 0.0};
  if (parameters.empty()) return {};
  const std::size_t n = std::min(parameters.size(), kMostRows);
  const double height = 116.0 + kRowPx * static_cast<double>(n);
  SvgDocument svg(760.0, height, "Parameters with their standard deviations");
  svg.text(24.0, 24.0, "Parameters: fitted value, one and two standard deviations", Anchor::kStart, "h");
  svg.text(24.0, 44.0,
           "in standard deviations of the prior about the declared value; of effects, in shares of the value",
           Anchor::kStart, "s q");
  PlotPanel panel(svg, {kColumn.x, kColumn.y, kColumn.width, kRowPx * static_cast<double>(n)}, {-3.0, 3.0, false, {}},
                  {0.0, static_cast<double>(n), false, {}});
  panel.draw_x_axis(true, 6);
  panel.draw_frame();
  for (std::size_t i = 0; i < n; ++i) {
    const FittedParameter& p = parameters[i];
    const double y = kColumn.y + kRowPx * (static_cast<double>(i) + 0.5);
    const bool has_prior = p.declared && p.prior_sigma && *p.prior_sigma > 0.0;
    const double unit = has_prior ? *p.prior_sigma : std::abs(p.value);
    const double at = has_prior ? (p.value - *p.declared) / unit : 0.0;
    const auto clamped = [&](double value) { return panel.x_px(std::clamp(value, -3.0, 3.0)); };
    if (p.sigma && unit > 0.0) {
      const double wide = *p.sigma / unit;
      svg.line(clamped(at - 2.0 * wide), y, clamped(at + 2.0 * wide), y, "k0");
      svg.rect({clamped(at - wide), y - 4.0, std::max(clamped(at + wide) - clamped(at - wide), 1.0), 8.0}, "m0");
    }
    svg.marker(clamped(at), y, 4.0, Marker::kDiamond, "m1");
    svg.text(24.0, y + 4.0, shortened(p.name, 30));
    const std::string unit_text = p.unit == "1" ? "" : " " + p.unit;
    svg.text(kColumn.right() + 16.0, y + 4.0,
             p.sigma ? fmt::format("{:.5g} ± {:.2g}{}", p.value, *p.sigma, unit_text)
                     : fmt::format("{:.5g}{} (no sigma)", p.value, unit_text),
             Anchor::kStart, "s");
  }
  return svg.text_of();
}

}  // namespace app
