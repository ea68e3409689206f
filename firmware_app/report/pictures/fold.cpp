#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "firmware_app/report/pictures/parts.h"
#include "firmware_app/report/plot/mode_labels.h"
#include "firmware_app/report/plot/svg_plot.h"
#include "firmware_app/report/plot/verdict_marks.h"

namespace app {
namespace {

constexpr int kMaxBands = 24;

// Frequencies of band k, k half-rates wide apart, fold onto 0 .. rate / 2: even bands upward, odd ones downward.
double true_frequency(double apparent_hz, int band, double rate_hz) noexcept {
  return band % 2 == 0 ? band / 2 * rate_hz + apparent_hz : (band + 1) / 2 * rate_hz - apparent_hz;
}

class FoldMap {
 public:
  FoldMap(const PictureInputs& inputs, const PictureFormat& format)
      : inputs_(inputs), format_(format), rate_hz_(inputs.estimate->rate_hz) {
    const double half = rate_hz_ / 2.0;
    searched_hz_ = std::max(half, inputs.max_frequency_hz);
    double highest = std::max(rate_hz_, searched_hz_);
    for (const core::Mode& mode : inputs.estimate->modes) {
      if (std::isfinite(mode.frequency_hz)) highest = std::max(highest, mode.frequency_hz);
    }
    n_bands_ = std::clamp(static_cast<int>(std::ceil(highest / half - 1e-9)), 2, kMaxBands);
  }

  [[nodiscard]] std::string draw() {
    const double half = rate_hz_ / 2.0;
    const double right = 14.0;
    Box box{62.0, 8.0, format_.width_px - 62.0 - right, is_narrow(format_) ? 240.0 : 280.0};
    SvgDocument svg(format_.width_px, box.bottom() + 46.0, "Apparent against true frequency", format_.on_page);
    PlotPanel panel(svg, box, {0.0, half, false, "apparent frequency, Hz"},
                    {0.0, n_bands_ * half, false, "true frequency, Hz"});
    panel.begin_readout("marks");
    panel.draw_x_axis(true, is_narrow(format_) ? 6 : 14);
    panel.draw_y_axis(true, is_narrow(format_) ? 6 : 8);
    panel.draw_frame();
    draw_branches(panel);
    for (const core::Mode& mode : inputs_.estimate->rejected) {
      if (mode.verdict == core::Verdict::kAmbiguous) draw_mode(svg, panel, mode);
    }
    for (const core::Mode& mode : inputs_.estimate->modes) draw_mode(svg, panel, mode);
    draw_labels(svg, panel);
    panel.end_readout();
    return svg.text_of();
  }

 private:
  // Drawn solid up to the highest true frequency that was searched.
  void draw_branches(PlotPanel& panel) const {
    for (int band = 0; band < n_bands_; ++band) {
      const double half = rate_hz_ / 2.0;
      const double split = std::clamp(searched_hz_ - band * half, 0.0, half);
      const auto branch = [&](double from, double to, const char* css_class) {
        if (to - from < 1e-9 * half) return;
        const auto at = [&](double up) {
          const double apparent = band % 2 == 0 ? up : half - up;
          return PlotPoint{apparent, true_frequency(apparent, band, rate_hz_)};
        };
        const std::vector<PlotPoint> line{at(from), at(to)};
        panel.curve(line, css_class);
      };
      branch(0.0, split, "k0");
      branch(split, half, "k7 d2");
    }
  }

  void draw_mode(SvgDocument& svg, const PlotPanel& panel, const core::Mode& mode) {
    const double half = rate_hz_ / 2.0;
    if (!(mode.apparent_hz >= 0.0 && mode.apparent_hz <= half) || !std::isfinite(mode.frequency_hz)) return;
    const VerdictMark& mark = mark_of(mode.verdict);
    const double x = panel.x_px(mode.apparent_hz);
    svg.line(x, panel.box().y, x, panel.box().bottom(), mark.line_class, say_attribute(mode));
    for (int band = 0; band < n_bands_; ++band) {
      const double candidate = true_frequency(mode.apparent_hz, band, rate_hz_);
      const bool chosen = std::abs(candidate - mode.frequency_hz) < 0.02 * rate_hz_;
      if (!chosen && candidate > searched_hz_) continue;
      const double y = panel.y_px(candidate);
      taken_.push_back({x - 6.0, y - 6.0, 12.0, 12.0});
      if (chosen) {
        svg.marker(x, y, 5.0, mark.marker, mark.marker_class);
      } else {
        svg.marker(x, y, 4.0, Marker::kRing, "k7 n");
      }
    }
  }

  // Placed beside the chosen frequency, if possible on the free side of its branch; left out where there is no room.
  void draw_labels(SvgDocument& svg, const PlotPanel& panel) {
    for (const core::Mode& mode : inputs_.estimate->modes) {
      const bool inside = mode.apparent_hz >= 0.0 && mode.apparent_hz <= rate_hz_ / 2.0;
      if (!inside || !std::isfinite(mode.frequency_hz)) continue;
      const std::string label = four_digits_text(mode.frequency_hz) + " Hz";
      const double width = 0.9 * text_width_px(label, kTextPx);  // digits are narrow
      const double x = panel.x_px(mode.apparent_hz), y = panel.y_px(mode.frequency_hz);
      const bool upward = static_cast<int>(mode.frequency_hz / (rate_hz_ / 2.0)) % 2 == 0;
      const Box right{x + 9.0, 0.0, width, 15.0}, left{x - width - 9.0, 0.0, width, 15.0};
      const double below = y + 5.0, above = y - 20.0;
      const std::pair<Box, double> places[] = {{right, upward ? below : above},
                                               {left, upward ? above : below},
                                               {left, upward ? below : above},
                                               {right, upward ? above : below},
                                               {left, y - 38.0},
                                               {right, y - 38.0},
                                               {left, y + 23.0},
                                               {right, y + 23.0}};
      // Further away a label could be attributed to another mode: allowed only where the true frequency differs from
      // the apparent.
      const std::size_t n_places = is_folded(mode) ? std::size(places) : 4;
      for (auto [place, top] : std::span(places, n_places)) {
        place.y = top;
        if (!free(panel, place)) continue;
        taken_.push_back(place);
        svg.rect(place, "b");
        svg.text(place.x, place.y + 12.0, label);
        break;
      }
    }
  }

  [[nodiscard]] bool free(const PlotPanel& panel, const Box& place) const {
    const Box& box = panel.box();
    if (place.x < box.x || place.right() > box.right() || place.y < box.y || place.bottom() > box.bottom())
      return false;
    for (int band = 0; band < n_bands_; ++band) {
      const auto y_at = [&](double x) {
        const double apparent = (x - box.x) / box.width * rate_hz_ / 2.0;
        return panel.y_px(true_frequency(apparent, band, rate_hz_));
      };
      const double one = y_at(place.x), other = y_at(place.right());
      if (std::min(one, other) < place.bottom() && std::max(one, other) > place.y) return false;
    }
    return std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) { return overlap(place, other); });
  }

  const PictureInputs& inputs_;
  PictureFormat format_;
  double rate_hz_, searched_hz_ = 0.0;
  int n_bands_ = 2;
  std::vector<Box> taken_;  // of the markers, then of the labels
};

}  // namespace

std::string fold_map_svg(const PictureInputs& inputs, const PictureFormat& format) {
  const bool known =
      inputs.estimate != nullptr && std::isfinite(inputs.estimate->rate_hz) && inputs.estimate->rate_hz > 0.0;
  return known ? FoldMap(inputs, format).draw() : std::string();
}

}  // namespace app
