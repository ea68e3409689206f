#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "firmware_app/report/pictures/parts.h"
#include "firmware_app/report/plot/mode_labels.h"
#include "firmware_app/report/plot/spectral_matrix.h"
#include "firmware_app/report/plot/spectrum_curves.h"
#include "firmware_app/report/plot/svg_plot.h"
#include "firmware_app/report/plot/verdict_marks.h"

namespace app {
namespace {

constexpr int kMaxDecades = 10;
constexpr std::size_t kMaxLegendCharacters = 18;

struct Curve {
  std::vector<PlotPoint> points;
  std::string css_class;
};

// Every channel, then (on the page) the cross-spectrum of the two strongest.
std::vector<Curve> curves_of(const PictureInputs& inputs, const PictureFormat& format) {
  const core::CpsdSums& sums = *inputs.spectrum;
  const std::size_t max_points = curve_points(static_cast<std::size_t>(sums.n_channels) + 1, format);
  std::vector<Curve> out;
  for (int c = 0; c < sums.n_channels; ++c)
    out.push_back({decimated(density(sums, c), max_points), line_class(static_cast<std::size_t>(c))});
  if (!format.on_page) return out;
  if (const auto pair = strongest_pair(sums, inputs.channels))
    out.push_back({decimated(cross_density(sums, pair->first, pair->second), max_points), "cross"});
  return out;
}

std::string name_of(const PictureInputs& inputs, int channel) {
  const auto i = static_cast<std::size_t>(channel);
  const std::string name = i < inputs.channels.size() ? inputs.channels[i].name : fmt::format("channel {}", i);
  return shortened(name, kMaxLegendCharacters);
}

std::size_t n_rejected(const PictureInputs& inputs, core::Verdict verdict) {
  if (inputs.estimate == nullptr) return 0;
  const auto& rejected = inputs.estimate->rejected;
  return static_cast<std::size_t>(
      std::count_if(rejected.begin(), rejected.end(), [&](const core::Mode& mode) { return mode.verdict == verdict; }));
}

class SpectraPicture {
 public:
  // `quantity`: of the vertical axis, in the displacement's unit squared per Hz.
  SpectraPicture(const PictureInputs& inputs, const PictureFormat& format, std::vector<Curve> curves, const char* title,
                 const char* quantity)
      : inputs_(inputs), format_(format), curves_(std::move(curves)), title_(title) {
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    for (const Curve& curve : curves_) {
      for (const PlotPoint& point : curve.points) {
        if (std::isfinite(point.y)) low = std::min(low, point.y), high = std::max(high, point.y);
      }
    }
    x_ = {0.0, inputs.spectrum->rate_hz / 2.0, false, "frequency, Hz"};
    y_ = log_axis_around(low, high, kMaxDecades, fmt::format("{}, {}²/Hz", quantity, inputs.unit));
    if (!format.on_page) add_legend();
  }

  [[nodiscard]] std::string draw() {
    const double right = format_.on_page ? 14.0 : legend_px_ + 20.0;
    Box box{kLeftPx, 0.0, format_.width_px - kLeftPx - right, is_narrow(format_) ? 300.0 : 420.0};
    const ModeLabels labels(inputs_.estimate, x_.high, box.x, box.width, format_);
    box.y = (format_.on_page ? 8.0 : 44.0) + labels.height_px();
    SvgDocument svg(format_.width_px, box.bottom() + 46.0, title_, format_.on_page);
    if (!format_.on_page) {
      svg.text(kLeftPx, 24.0, "Power spectral density of the displacement", Anchor::kStart, "h");
      svg.text(format_.width_px - 14.0, 24.0, spectra_remark(inputs_), Anchor::kEnd, "t q");
    }
    PlotPanel panel(svg, box, x_, y_);
    panel.begin_readout("curves");
    panel.draw_x_axis(true, is_narrow(format_) ? 6 : 14);
    panel.draw_y_axis(true, 12);
    draw_rejected(svg, panel, inputs_.estimate, x_.high, format_);
    panel.draw_frame();
    // Drawn from last to first: the broad cross-spectrum lies behind the channels.
    for (std::size_t i = curves_.size(); i-- > 0;)
      panel.curve(curves_[i].points, curves_[i].css_class, format_.on_page ? fmt::format("data-k=\"{}\"", i) : "");
    labels.draw(svg, panel);
    panel.end_readout();
    if (!format_.on_page) draw_legend(svg, {box.right() + 14.0, box.y, legend_px_, box.height}, legend_);
    return svg.text_of();
  }

 private:
  static constexpr double kLeftPx = 62.0;

  // Verdicts come first, because a long list of channels may be cut.
  void add_legend() {
    if (inputs_.estimate != nullptr && !inputs_.estimate->modes.empty()) legend_.push_back({"mode", "v"});
    for (const VerdictMark& mark : verdict_marks()) {
      const bool drawn = mark.verdict != core::Verdict::kNumerical && mark.verdict != core::Verdict::kStructural;
      if (drawn && n_rejected(inputs_, mark.verdict) > 0) legend_.push_back({mark.label, mark.line_class});
    }
    for (const LegendEntry& entry : spectra_legend(inputs_)) legend_.push_back(entry);
    for (const LegendEntry& entry : legend_)
      legend_px_ = std::max(legend_px_, 34.0 + text_width_px(entry.label, kTextPx));
  }

  const PictureInputs& inputs_;
  PictureFormat format_;
  std::vector<Curve> curves_;
  const char* title_;
  PlotAxis x_, y_;
  std::vector<LegendEntry> legend_;
  double legend_px_ = 90.0;
};

}  // namespace

std::string spectra_svg(const PictureInputs& inputs, const PictureFormat& format) {
  if (!is_drawable(inputs.spectrum)) return {};
  return SpectraPicture(inputs, format, curves_of(inputs, format), "Power spectral density of every channel",
                        "displacement")
      .draw();
}

std::string singular_values_svg(const PictureInputs& inputs, const PictureFormat& format) {
  if (inputs.lines == nullptr || inputs.lines->lines.empty()) return {};
  std::vector<Curve> curves;
  for (std::size_t k = 0; k < inputs.lines->n_singular; ++k) {
    std::vector<PlotPoint> points;
    for (const SpectralLine& line : inputs.lines->lines) {
      const double value = line.singular[k];
      points.push_back({line.frequency_hz, value > 0.0 ? value : std::numeric_limits<double>::quiet_NaN()});
    }
    curves.push_back({decimated(points, curve_points(kMaxSingular, format)), line_class(k)});
  }
  return SpectraPicture(inputs, format, std::move(curves), "Singular values of the spectral matrix", "singular value")
      .draw();
}

std::vector<LegendEntry> spectra_legend(const PictureInputs& inputs) {
  std::vector<LegendEntry> out;
  if (!is_drawable(inputs.spectrum)) return out;
  for (int c = 0; c < inputs.spectrum->n_channels; ++c)
    out.push_back({name_of(inputs, c), line_class(static_cast<std::size_t>(c))});
  return out;
}

std::string cross_label(const PictureInputs& inputs) {
  if (!is_drawable(inputs.spectrum)) return {};
  const auto pair = strongest_pair(*inputs.spectrum, inputs.channels);
  return pair ? fmt::format("|{} × {}|", name_of(inputs, pair->first), name_of(inputs, pair->second)) : std::string();
}

std::string spectra_remark(const PictureInputs& inputs) {
  const core::CpsdSums& sums = *inputs.spectrum;
  const std::size_t n = inputs.estimate == nullptr ? 0 : inputs.estimate->modes.size();
  const std::string modes = n == 0 ? "no modes" : n == 1 ? "1 mode" : fmt::format("{} modes", n);
  return fmt::format("{}, {} segments, {:.2g} Hz between bins", modes, sums.n_segments, sums.rate_hz / sums.n_fft);
}

}  // namespace app
