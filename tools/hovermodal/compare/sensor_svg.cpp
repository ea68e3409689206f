#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware_app/report/plot/svg_plot.h"
#include "tools/hovermodal/compare/sensor.h"

namespace tools {
namespace {

constexpr double kSensorWidth_px = 1000.0, kSensorPanel_px = 200.0, kSensorLeft_px = 70.0;
constexpr std::size_t kSensorPoints = 2000;
constexpr double kShownPeriods = 60.0;  // of the upper limit, in the first panel

using Points = std::vector<app::PlotPoint>;

class SensorPicture {
 public:
  explicit SensorPicture(const SensorFindings& findings)
      : findings_(findings),
        found_(findings.comparison),
        svg_(kSensorWidth_px, 3.0 * (kSensorPanel_px + 70.0) + 60.0, "Channel against sensor") {}

  [[nodiscard]] std::string draw() {
    svg_.text(kSensorLeft_px, 20.0,
              fmt::format("{} against {}, {:.3g} ... {:.3g} Hz", findings_.channel, findings_.sensor_channel,
                          found_.band.low_hz, found_.band.high_hz),
              app::Anchor::kStart, "h");
    const double rmse = findings_.is_scaled ? found_.rmse_scaled : found_.rmse;
    svg_.text(kSensorLeft_px, 40.0,
              fmt::format("RMSE {:.3g} {}, correlation {:.4f}, coherence {:.4f}", rmse, findings_.unit,
                          found_.correlation, found_.coherence));
    draw_key();
    scale_ = findings_.is_scaled ? std::abs(found_.alignment.ratio) : 1.0;
    draw_middle();
    draw_all();
    draw_spectra();
    return svg_.text_of();
  }

 private:
  void draw_key() {
    double x = kSensorLeft_px + 480.0;
    for (const auto& [label, colour] : {std::pair{"camera", 0U}, {"sensor", 1U}, {"camera - sensor", 2U}}) {
      svg_.line(x, 36.0, x + 24.0, 36.0, app::line_class(colour));
      svg_.text(x + 30.0, 40.0, label);
      x += 50.0 + app::text_width_px(label, app::kTextPx);
    }
  }

  [[nodiscard]] app::Box box(int row) const {
    return {kSensorLeft_px, 60.0 + row * (kSensorPanel_px + 70.0), kSensorWidth_px - kSensorLeft_px - 20.0,
            kSensorPanel_px};
  }

  [[nodiscard]] Points points(const std::vector<double>& value, double from_s, double to_s, double scale) const {
    Points out;
    for (std::size_t k = 0; k < value.size(); ++k) {
      if (found_.t_s[k] < from_s || found_.t_s[k] > to_s) continue;
      const bool gap = k > 0 && found_.t_s[k] - found_.t_s[k - 1] > 1.5 / findings_.camera_rate_hz;
      if (gap) out.push_back({found_.t_s[k] + findings_.camera_first_s, std::nan("")});
      out.push_back({found_.t_s[k] + findings_.camera_first_s, scale * value[k]});
    }
    return app::decimated(out, kSensorPoints);
  }

  void panel_of(int row, const std::vector<std::pair<Points, int>>& curves) {
    double low = 0.0, high = 0.0;
    for (const auto& [curve, colour] : curves) {
      for (const app::PlotPoint& point : curve) {
        if (std::isfinite(point.y)) low = std::min(low, point.y), high = std::max(high, point.y);
      }
    }
    const Points& first = curves.front().first;
    const double from = first.empty() ? 0.0 : first.front().x,
                 to = first.empty() ? 1.0 : std::max(from + 1e-6, first.back().x);
    app::PlotPanel panel(svg_, box(row), {from, to, false, "time of the camera, s"},
                         app::axis_around(low, high, findings_.unit));
    panel.draw_x_axis(true);
    panel.draw_y_axis(true);
    panel.draw_frame();
    for (const auto& [curve, colour] : curves) panel.curve(curve, app::line_class(static_cast<std::size_t>(colour)));
  }

  // A stretch in the middle, in which single periods can be seen.
  void draw_middle() {
    const double middle_s = 0.5 * (found_.t_s.front() + found_.t_s.back()),
                 half_s = 0.5 * kShownPeriods / found_.band.high_hz;
    panel_of(0, {{points(found_.camera, middle_s - half_s, middle_s + half_s, 1.0), 0},
                 {points(found_.sensor, middle_s - half_s, middle_s + half_s, scale_), 1}});
  }

  void draw_all() {
    std::vector<double> difference;
    for (std::size_t k = 0; k < found_.t_s.size(); ++k)
      difference.push_back(found_.camera[k] - scale_ * found_.sensor[k]);
    const double from_s = found_.t_s.front(), to_s = found_.t_s.back();
    panel_of(1, {{points(found_.camera, from_s, to_s, 1.0), 0}, {points(difference, from_s, to_s, 1.0), 2}});
  }

  void draw_spectra() {
    Points camera, sensor;
    double low = 1e300, high = 0.0;
    for (const core::ComparedBin& bin : found_.spectrum) {
      camera.push_back({bin.frequency_hz, bin.camera});
      sensor.push_back({bin.frequency_hz, scale_ * scale_ * bin.sensor});
      for (const double value : {camera.back().y, sensor.back().y}) {
        if (value > 0.0) low = std::min(low, value), high = std::max(high, value);
      }
    }
    if (camera.empty() || !(high > 0.0)) return;
    app::PlotPanel panel(
        svg_, box(2),
        {std::min(camera.front().x, found_.band.low_hz), std::max(found_.band.high_hz, camera.back().x), false,
         "frequency, Hz; vertical lines: the band"},
        app::log_axis_around(low, high, 8, findings_.unit + "²/Hz"));
    panel.draw_x_axis(true);
    panel.draw_y_axis(true);
    panel.draw_frame();
    panel.curve(camera, app::line_class(0));
    panel.curve(sensor, app::line_class(1));
    panel.vertical(found_.band.low_hz, "v");
    panel.vertical(found_.band.high_hz, "v");
  }

  const SensorFindings& findings_;
  const core::SensorComparison& found_;
  app::SvgDocument svg_;
  double scale_ = 1.0;
};

}  // namespace

std::string sensor_svg(const SensorFindings& findings) { return SensorPicture(findings).draw(); }

}  // namespace tools
