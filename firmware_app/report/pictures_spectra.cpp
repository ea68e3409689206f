#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "firmware_app/report/pictures_parts.h"
#include "firmware_app/report/svg_plot.h"

namespace app {
namespace {

constexpr double kLeftPx = 66.0;
constexpr double kPlotHeightPx = 420.0;
constexpr double kRowPx = 15.0;
constexpr int kMaxLabelRows = 6;
constexpr int kMaxDecades = 10;
constexpr std::size_t kMaxNameCharacters = 18;

// Poles that are no modes of the structure but have a cause; the others are only in modal.json.
struct RejectedStyle {
  core::Verdict verdict;
  const char* label;
  const char* css_class;
};
constexpr std::array kRejectedStyles{RejectedStyle{core::Verdict::kCameraMotion, "camera motion", "w"},
                                     RejectedStyle{core::Verdict::kInputPeak, "input peak", "w i"},
                                     RejectedStyle{core::Verdict::kHarmonic, "harmonic", "w o"}};

bool drawable(const PictureInputs& inputs) {
  const core::CpsdSums* sums = inputs.spectrum;
  if (sums == nullptr || sums->n_channels < 1 || sums->n_fft < 4 || sums->n_segments == 0) return false;
  const auto n_values = static_cast<std::size_t>(sums->n_bins()) * static_cast<std::size_t>(sums->n_pairs());
  return sums->data_sum.size() == n_values && sums->rate_hz > 0.0 && sums->window_power > 0.0;
}

// One-sided power spectral density, from bin 1 on: the segments' means were removed.
std::vector<PlotPoint> density(const core::CpsdSums& sums, int channel) {
  const int pair = core::CpsdSums::pair_index(channel, channel, sums.n_channels);
  const double divisor = sums.rate_hz * sums.window_power * static_cast<double>(sums.n_segments);
  std::vector<PlotPoint> out;
  for (int k = 1; k < sums.n_bins(); ++k) {
    const auto at =
        static_cast<std::size_t>(k) * static_cast<std::size_t>(sums.n_pairs()) + static_cast<std::size_t>(pair);
    const double sides = 2 * k == sums.n_fft ? 1.0 : 2.0;
    const double value = sides * sums.data_sum[at].real() / divisor;
    // A channel that never moved has no place on a logarithmic axis.
    out.push_back({k * sums.rate_hz / sums.n_fft, value > 0.0 ? value : std::numeric_limits<double>::quiet_NaN()});
  }
  return out;
}

std::vector<core::Mode> by_apparent_frequency(const PictureInputs& inputs) {
  std::vector<core::Mode> out;
  if (inputs.estimate == nullptr) return out;
  const double highest = inputs.spectrum->rate_hz / 2.0;
  for (const core::Mode& mode : inputs.estimate->modes) {
    if (mode.apparent_hz >= 0.0 && mode.apparent_hz <= highest) out.push_back(mode);
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.apparent_hz < b.apparent_hz; });
  return out;
}

class SpectraPicture {
 public:
  explicit SpectraPicture(const PictureInputs& inputs) : inputs_(inputs), modes_(by_apparent_frequency(inputs)) {
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    const int n_channels = inputs.spectrum->n_channels;
    for (int c = 0; c < n_channels; ++c) {
      std::vector<PlotPoint> points = density(*inputs.spectrum, c);
      for (const PlotPoint& point : points) {
        if (std::isfinite(point.y)) low = std::min(low, point.y), high = std::max(high, point.y);
      }
      curves_.push_back(decimated(points, curve_points(static_cast<std::size_t>(n_channels))));
    }
    x_ = {0.0, inputs.spectrum->rate_hz / 2.0, false, "frequency, Hz"};
    y_ =
        log_axis_around(low, high, kMaxDecades, fmt::format("displacement, {0}²/Hz", inputs.millimetres ? "mm" : "px"));
  }

  [[nodiscard]] std::string draw() {
    add_legend_of_channels();
    place_labels();
    const double top = 44.0 + kRowPx * n_rows_;
    SvgDocument svg(kPictureWidthPx, top + kPlotHeightPx + 46.0, "Power spectral density of every channel");
    svg.text(kLeftPx, 24.0, "Power spectral density of the displacement", Anchor::kStart, "h");
    svg.text(kPictureWidthPx - 14.0, 24.0, remark(), Anchor::kEnd, "t q");
    const Box box{kLeftPx, top, plot_width(), kPlotHeightPx};
    PlotPanel panel(svg, box, x_, y_);
    panel.draw_x_axis(true, 14);
    panel.draw_y_axis(true, 12);
    draw_rejected(panel);
    panel.draw_frame();
    for (std::size_t i = 0; i < curves_.size(); ++i) panel.curve(curves_[i], line_class(i));
    draw_modes(svg, panel);
    draw_legend(svg, {box.right() + 14.0, top, legend_px_, kPlotHeightPx}, legend_);
    return svg.text_of();
  }

 private:
  [[nodiscard]] double plot_width() const noexcept { return kPictureWidthPx - kLeftPx - legend_px_ - 20.0; }
  [[nodiscard]] double x_px(double frequency_hz) const noexcept {
    return kLeftPx + plot_width() * frequency_hz / x_.high;
  }

  [[nodiscard]] std::string remark() const {
    const core::CpsdSums& sums = *inputs_.spectrum;
    const std::string modes = modes_.empty()       ? "no modes"
                              : modes_.size() == 1 ? "1 mode"
                                                   : fmt::format("{} modes", modes_.size());
    return fmt::format("{}, {} segments, {:.2g} Hz between bins", modes, sums.n_segments, sums.rate_hz / sums.n_fft);
  }

  void add_legend_of_channels() {
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      const bool named = i < inputs_.channels.size();
      const std::string name = named ? inputs_.channels[i].name : fmt::format("channel {}", i);
      legend_.push_back({shortened(name, kMaxNameCharacters), line_class(i)});
    }
    // Causes first: a long list of channels may be cut.
    std::vector<LegendEntry> causes;
    if (!modes_.empty()) causes.push_back({"mode", "v"});
    for (const RejectedStyle& style : kRejectedStyles) {
      if (n_rejected(style.verdict) > 0) causes.push_back({style.label, style.css_class});
    }
    legend_.insert(legend_.begin(), causes.begin(), causes.end());
    for (const LegendEntry& entry : legend_)
      legend_px_ = std::max(legend_px_, 34.0 + text_width_px(entry.label, kTextPx));
  }

  [[nodiscard]] std::size_t n_rejected(core::Verdict verdict) const {
    if (inputs_.estimate == nullptr) return 0;
    const auto& rejected = inputs_.estimate->rejected;
    return static_cast<std::size_t>(std::count_if(rejected.begin(), rejected.end(),
                                                  [&](const core::Mode& mode) { return mode.verdict == verdict; }));
  }

  void place_labels() {
    std::vector<double> centres;
    for (const core::Mode& mode : modes_) {
      labels_.push_back(frequency_text(mode, false));
      const double half = text_width_px(labels_.back(), kTextPx) / 2.0;
      centres.push_back(std::clamp(x_px(mode.apparent_hz), half + 6.0, kPictureWidthPx - half - 6.0));
    }
    rows_ = label_rows(centres, labels_, kMaxLabelRows);
    for (const int row : rows_) n_rows_ = std::max(n_rows_, row + 1);
    label_x_px_ = std::move(centres);
  }

  void draw_rejected(PlotPanel& panel) const {
    if (inputs_.estimate == nullptr) return;
    for (const RejectedStyle& style : kRejectedStyles) {
      for (const core::Mode& mode : inputs_.estimate->rejected) {
        const bool inside = mode.apparent_hz >= 0.0 && mode.apparent_hz <= x_.high;
        if (mode.verdict == style.verdict && inside) panel.vertical(mode.apparent_hz, style.css_class);
      }
    }
  }

  void draw_modes(SvgDocument& svg, PlotPanel& panel) const {
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      const double x = panel.x_px(modes_[i].apparent_hz);
      const double y = panel.box().y - 5.0 - kRowPx * std::max(0, rows_[i]);
      svg.line(x, rows_[i] > 0 ? y + 3.0 : panel.box().y, x, panel.box().bottom(), "v");
    }
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      if (rows_[i] < 0) continue;
      const double y = panel.box().y - 5.0 - kRowPx * rows_[i];
      const double half = text_width_px(labels_[i], kTextPx) / 2.0;
      svg.rect({label_x_px_[i] - half, y - 11.0, 2.0 * half, 13.0}, "b");  // lines of other modes end behind it
      svg.text(label_x_px_[i], y, labels_[i], Anchor::kMiddle);
    }
  }

  const PictureInputs& inputs_;
  std::vector<core::Mode> modes_;
  std::vector<std::vector<PlotPoint>> curves_;
  PlotAxis x_, y_;
  std::vector<LegendEntry> legend_;
  std::vector<std::string> labels_;
  std::vector<double> label_x_px_;
  std::vector<int> rows_;
  int n_rows_ = 0;
  double legend_px_ = 90.0;
};

}  // namespace

std::string spectra_svg(const PictureInputs& inputs) {
  return drawable(inputs) ? SpectraPicture(inputs).draw() : std::string();
}

}  // namespace app
