#include "tools/validate/geometry_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "core/simulation/scene_motion.h"
#include "core/spectrum/welch_cpsd.h"
#include "drivers/storage/json.h"
#include "firmware_app/report/plot/lane_picture.h"
#include "firmware_app/report/plot/spectrum_curves.h"
#include "firmware_app/report/plot/svg_plot.h"

namespace tools {
namespace {

using app::Box;
using app::PlotAxis;
using app::PlotPanel;
using app::PlotPoint;
using app::SvgDocument;

constexpr double kShown_s = 30.0;  // the paper shows so much of its record
constexpr double kWidthPx = 1000.0;
constexpr std::array<const char*, 3> kSensorNames{"accelerometers", "stationary camera", "camera in flight"};

app::Lane lane(std::string name, std::vector<PlotPoint> points, std::vector<std::vector<PlotPoint>> behind) {
  app::Lane out;
  out.name = std::move(name);
  out.low = std::numeric_limits<double>::infinity(), out.high = -out.low;
  for (const PlotPoint& point : points) out.low = std::min(out.low, point.y), out.high = std::max(out.high, point.y);
  for (const auto& curve : behind) {
    for (const PlotPoint& point : curve) out.low = std::min(out.low, point.y), out.high = std::max(out.high, point.y);
  }
  out.empty = points.empty();
  out.points = std::move(points);
  out.behind = std::move(behind);
  return out;
}

core::CpsdSums spectra_of(const app::ChannelSeries& series, int segment) {
  core::WelchConfig config;
  config.n_channels = static_cast<int>(series.channels.size());
  config.segment = segment;
  config.rate_hz = series.rate_hz;
  core::WelchCpsd welch(config);
  std::vector<double> value(series.channels.size());
  const std::vector<std::uint8_t> seen(value.size(), 1);
  for (std::size_t k = 0; k < series.value.front().size(); ++k) {
    for (std::size_t c = 0; c < value.size(); ++c) value[c] = series.value[c][k];
    (void)welch.push(value, seen);
  }
  welch.flush();
  return welch.sums();
}

int channel_named(const std::vector<core::ChannelInfo>& channels, const std::string& name) {
  const auto at = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.name == name; });
  return static_cast<int>(at - channels.begin());
}

std::vector<PlotPoint> floors_5_and_6(const core::CpsdSums& sums, const std::vector<core::ChannelInfo>& channels) {
  const int a = channel_named(channels, "floor5"), b = channel_named(channels, "floor6");
  return app::cross_density(sums, std::min(a, b), std::max(a, b));
}

// As displacement.
std::vector<PlotPoint> integrated_twice(std::vector<PlotPoint> density, double up_to_hz) {
  std::erase_if(density, [&](const PlotPoint& point) { return point.x > up_to_hz; });
  for (PlotPoint& point : density) point.y /= std::pow(2.0 * std::numbers::pi * point.x, 4);
  return density;
}

std::string cpsd_figure(const PaperPictures::Record& record) {
  constexpr double kTop_hz = 12.5;
  const core::CpsdSums acceleration = spectra_of(record.acceleration, 32768),
                       still = spectra_of(record.stationary.series, 1024);
  const std::array<std::vector<PlotPoint>, 3> curves{
      integrated_twice(floors_5_and_6(acceleration, record.acceleration.channels), kTop_hz),
      floors_5_and_6(still, record.stationary.series.channels),
      floors_5_and_6(record.flight.ways.front().sums, record.flight.ways.front().channels)};
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const auto& curve : curves) {
    for (const PlotPoint& point : curve) {
      if (point.x > 0.3 && std::isfinite(point.y)) low = std::min(low, point.y), high = std::max(high, point.y);
    }
  }
  const Box box{72.0, 44.0, kWidthPx - 72.0 - 190.0, 420.0};
  SvgDocument svg(kWidthPx, box.bottom() + 46.0, "Cross power spectral density of floors 5 and 6");
  svg.text(box.x, 24.0, "Cross power spectral density of floors 5 and 6, magnitude", app::Anchor::kStart, "h");
  PlotPanel panel(svg, box, {0.0, kTop_hz, false, "frequency, Hz"},
                  app::log_axis_around(low, high, 10, "displacement, mm²/Hz"));
  panel.draw_x_axis(true, 12);
  panel.draw_y_axis(true, 10);
  panel.draw_frame();
  std::vector<app::LegendEntry> legend;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    panel.curve(curves[i], app::line_class(i));
    legend.push_back({kSensorNames[i], app::line_class(i)});
  }
  app::draw_legend(svg, {box.right() + 14.0, box.y, 170.0, box.height}, legend);
  return svg.text_of();
}

// Real parts, the largest 1, turned to the same sign as the reference's.
std::vector<double> real_shape(const SensorMode& mode, const SensorMode& reference) {
  std::vector<double> out;
  std::complex<double> inner = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < mode.shape.size(); ++i) {
    if (i < reference.shape.size()) inner += std::conj(mode.shape[i]) * reference.shape[i];
    if (std::abs(mode.shape[i]) > std::abs(largest)) largest = mode.shape[i];
  }
  const std::complex<double> turn = std::abs(inner) > 0.0 ? inner / std::abs(inner) : 1.0;
  for (const auto& value : mode.shape) out.push_back((value * turn).real() / std::max(1e-12, std::abs(largest)));
  return out;
}

std::string shapes_figure(const PaperPictures::Record& record) {
  constexpr std::array<app::Marker, 3> kMarkers{app::Marker::kSquare, app::Marker::kRing, app::Marker::kCross};
  SvgDocument svg(kWidthPx, 470.0, "Mode shapes by three sensors");
  svg.text(72.0, 24.0, "Mode shapes by three sensors", app::Anchor::kStart, "h");
  std::vector<app::LegendEntry> legend;
  for (std::size_t i = 0; i < kSensorNames.size(); ++i) legend.push_back({kSensorNames[i], app::line_class(i)});
  app::draw_legend(svg, {830.0, 66.0, 165.0, 120.0}, legend);
  for (std::size_t r = 0; r < record.modes.front().size(); ++r) {
    const Box box{72.0 + 250.0 * static_cast<double>(r), 66.0, 220.0, 350.0};
    PlotPanel panel(svg, box, {-1.15, 1.15, false, "component"}, {0.0, 6.4, false, "floor"});
    panel.draw_x_axis(true, 5);
    panel.draw_y_axis(r == 0, 6);
    panel.draw_frame();
    const SensorMode& reference = record.modes.front()[r];
    svg.text(box.x + box.width / 2.0, box.y - 8.0, fmt::format("mode {}: {:.3f} Hz", r + 1, reference.frequency_hz),
             app::Anchor::kMiddle);
    for (std::size_t sensor = 0; sensor < kSensorNames.size(); ++sensor) {
      const std::vector<double> shape = real_shape(record.modes[sensor][r], reference);
      std::vector<PlotPoint> points{{0.0, 0.0}};
      for (std::size_t i = 0; i < shape.size(); ++i) points.push_back({shape[i], static_cast<double>(i + 1)});
      panel.curve(points, app::line_class(sensor));
      for (const PlotPoint& point : points) {
        svg.marker(panel.x_px(point.x), panel.y_px(point.y), 4.0, kMarkers[sensor], app::line_class(sensor) + " n");
      }
    }
  }
  return svg.text_of();
}

}  // namespace

void PaperPictures::add(const core::DisplacementSample& sample, const core::DisplacementSample& truth) {
  const double t_s = 1e-9 * static_cast<double>(sample.t_start_ns);
  if (t_s > kShown_s) return;
  scale_.push_back({t_s, sample.scale_mm_per_px});
  relative_.resize(sample.value_mm.size());
  absolute_.resize(sample.value_mm.size());
  for (std::size_t c = 0; c < relative_.size(); ++c) {
    relative_[c].push_back({t_s, sample.value_mm[c]});
    absolute_[c].push_back({t_s, truth.value_mm[c]});
  }
}

std::string PaperPictures::scale_figure(const Record& record) const {
  const core::simulation::SceneMotion motion(record.job.scene());
  const double plane_mm = record.job.scene().plates.front().z_mm;
  std::vector<PlotPoint> truth;
  for (const PlotPoint& point : scale_) {
    truth.push_back({point.x, (plane_mm - motion.camera().at(point.x).z_mm) / record.job.scene().camera.alpha_px});
  }
  app::Lane scale = lane("scale", scale_, {truth});
  scale.remark = fmt::format("{:.3f} to {:.3f}", scale.low, scale.high);
  return app::lanes_svg({scale}, kShown_s,
                        {"Scale over time; grey: the true distance over the focal length", "scale, mm/px", "mm/px", {}},
                        app::kFileFormat);
}

std::string PaperPictures::displacement_figure(const Record& record) const {
  std::vector<app::Lane> lanes;
  // From the roof down; the base is the last channel.
  const std::size_t n = relative_.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t c = i + 1 < n ? n - 2 - i : i;
    lanes.push_back(lane(record.flight.ways.front().channels[c].name, relative_[c], {absolute_[c]}));
  }
  return app::lanes_svg(lanes, kShown_s,
                        {"Displacement as seen in flight; grey: the true absolute one", "displacement, mm", "mm", {}},
                        app::kFileFormat);
}

void PaperPictures::write(const char* name, const std::string& text) const {
  drivers::write_file_atomically((std::filesystem::path(folder_) / name).string(), text);
}

void PaperPictures::draw(const Record& record) const {
  std::filesystem::create_directories(folder_);
  write("figure_6_scale.svg", scale_figure(record));
  write("figure_7_displacements.svg", displacement_figure(record));
  write("figure_8_cpsd.svg", cpsd_figure(record));
  write("figure_9_shapes.svg", shapes_figure(record));
}

}  // namespace tools
