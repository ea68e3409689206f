#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware_app/report/plot/svg_document.h"
#include "tools/hovermodal/calibrate/calibration_words.h"

namespace tools {
namespace {

constexpr double kWidthPx = 960.0, kMarginPx = 20.0, kTopPx = 66.0;

// A round magnification of the residuals, so that a typical one is about as long as a dot's diameter.
double magnification(double rms_px, double share) {
  const double wanted = 14.0 / std::max(rms_px * share, 1e-6);
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  const double steps = wanted / decade;
  return std::max(1.0, decade * (steps < 2.0 ? 1.0 : steps < 5.0 ? 2.0 : 5.0));
}

void draw_ninths(app::SvgDocument& svg, const CalibrationRun& run, const app::Box& box) {
  const std::vector<int> count = corners_per_ninth(run);
  for (int i = 1; i < 3; ++i) {
    const double x = box.x + i * box.width / 3.0, y = box.y + i * box.height / 3.0;
    svg.line(x, box.y, x, box.bottom(), "g");
    svg.line(box.x, y, box.right(), y, "g");
  }
  for (int i = 0; i < 9; ++i) {
    const int n = count[static_cast<std::size_t>(i)];
    svg.text(box.x + (i % 3) * box.width / 3.0 + 6.0, box.y + (i / 3) * box.height / 3.0 + 16.0,
             n == 0 ? "no corner" : fmt::format("{}", n), app::Anchor::kStart, "s q");
  }
}

}  // namespace

std::string calibration_svg(const CalibrationRun& run) {
  const double share = (kWidthPx - 2.0 * kMarginPx) / run.width_px;
  const app::Box box{kMarginPx, kTopPx, share * run.width_px, share * run.height_px};
  const double times = magnification(run.fit.rms_px, share);
  app::SvgDocument svg(kWidthPx, box.bottom() + kMarginPx, "Corners of the calibration and their residuals");
  svg.text(kMarginPx, 24.0,
           fmt::format("Calibration: {} views, reprojection error {:.3f} px rms", run.views.size(), run.fit.rms_px),
           app::Anchor::kStart, "h");
  svg.text(kMarginPx, 46.0,
           fmt::format("dots: corners seen; lines: seen minus predicted, {:g} times larger; numbers: corners per ninth",
                       times));
  svg.rect(box, "f");
  draw_ninths(svg, run, box);
  svg.begin_clip(box);
  for (std::size_t i = 0; i < run.views.size(); ++i) {
    for (std::size_t k = 0; k < run.views[i].size(); ++k) {
      const double x = share * (run.views[i][k].u + 0.5), y = share * (run.views[i][k].v + 0.5);
      const core::Vector2& r = run.fit.residual_px[i][k];
      const std::array<app::PlotPoint, 2> line{{{x, y}, {x + share * times * r.u, y + share * times * r.v}}};
      svg.path(line, app::line_class(0));
      svg.circle(x, y, 1.2, app::fill_class(1));
    }
  }
  svg.end_clip();
  return svg.text_of();
}

}  // namespace tools
