#include "tools/hovermodal/readout/residual_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "firmware_app/report/plot/svg_plot.h"

namespace tools {

std::string residual_svg(const ClipMotion& clip, const core::GyroReadout& found) {
  constexpr double kWidth_px = 720.0, kHeight_px = 300.0;
  const app::Box box{60.0, 44.0, kWidth_px - 80.0, kHeight_px - 96.0};
  app::SvgDocument svg(kWidth_px, kHeight_px, "Residual between the gyro's and the picture's motion");
  double top = 0.0;
  for (const double rms : found.pair_rms_without_px) top = std::max(top, rms);
  const double start_s = clip.pairs.empty() ? 0.0 : clip.pairs.front().from_s;
  const double length_s = clip.pairs.empty() ? 1.0 : std::max(1e-3, clip.pairs.back().to_s - start_s);
  app::PlotPanel panel(svg, box, {0.0, length_s, false, "time, s"}, {0.0, std::max(0.1, 1.1 * top), false, "rms, px"});
  panel.draw_x_axis(true);
  panel.draw_y_axis(true);
  panel.draw_frame();
  std::vector<app::PlotPoint> without, with;
  for (std::size_t k = 0; k < clip.pairs.size(); ++k) {
    const double t_s = clip.pairs[k].to_s - start_s;
    without.push_back({t_s, found.pair_rms_without_px[k]});
    with.push_back({t_s, found.pair_rms_with_px[k]});
  }
  panel.curve(without, app::line_class(0));
  panel.curve(with, app::line_class(1));
  for (std::size_t k = 0; k < clip.pairs.size(); ++k) {
    if (!clip.pairs[k].held_out) continue;
    svg.marker(panel.x_px(without[k].x), panel.y_px(without[k].y), 3.0, app::Marker::kRing, app::line_class(0));
    svg.marker(panel.x_px(with[k].x), panel.y_px(with[k].y), 3.0, app::Marker::kRing, app::line_class(1));
  }
  svg.text(box.x, 18.0, "Residual between the gyro's and the picture's motion", app::Anchor::kStart, "h");
  svg.text(
      box.x, 36.0,
      fmt::format("readout {:.2f} ± {:.2f} ms; held-out frames (rings): {:.2f} px with a readout of 0 (upper), "
                  "{:.2f} px with it",
                  1e3 * found.readout.readout_s, 1e3 * found.readout.std_s, found.rms_without_px, found.rms_with_px));
  return svg.text_of();
}

}  // namespace tools
