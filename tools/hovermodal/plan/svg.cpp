#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "firmware_app/report/plot/svg_plot.h"
#include "tools/hovermodal/plan/words.h"

namespace tools {
namespace {

using app::Anchor;
using app::Box;
using app::PlotPoint;
using core::planning::FoldOutlook;
using core::planning::HoverPlan;
using core::planning::ModePlan;
using core::planning::PlanInput;

constexpr double kWidthPx = 960.0, kLeftPx = 74.0, kRightPx = 190.0;
constexpr double kSpectrumPx = 260.0, kMapPx = 240.0, kRowPx = 15.0;
constexpr int kMaxRows = 4;
constexpr int kSpectrumPoints = 1500;

const char* dot_of(FoldOutlook outlook) noexcept {
  return outlook == FoldOutlook::kDirect ? "m0" : outlook == FoldOutlook::kResolved ? "m2" : "m1";
}

class PlanPicture {
 public:
  PlanPicture(const PlanInput& input, const HoverPlan& plan) : input_(input), plan_(plan) {
    order_.resize(plan.modes.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return plan.modes[a].place.apparent_hz < plan.modes[b].place.apparent_hz;
    });
    half_hz_ = input.camera.rate_hz / 2.0;
    floor_ = plan.floor.density_mm_per_sqrt_hz * plan.floor.density_mm_per_sqrt_hz;
    place_labels();
  }

  [[nodiscard]] std::string draw() {
    const double top = 46.0 + kRowPx * n_rows_;
    const double map_top = top + kSpectrumPx + 26.0;
    app::SvgDocument svg(kWidthPx, map_top + kMapPx + 46.0, "What the camera will see of each mode");
    svg.text(kLeftPx, 24.0,
             fmt::format("Planned hover of {:.1f} min, {:g} fps, {:.3g} mm/px", plan_.hover_s / 60.0,
                         input_.camera.rate_hz, plan_.mm_per_px),
             Anchor::kStart, "h");
    draw_spectrum(svg, {kLeftPx, top, kWidthPx - kLeftPx - kRightPx, kSpectrumPx});
    draw_map(svg, {kLeftPx, map_top, kWidthPx - kLeftPx - kRightPx, kMapPx});
    return svg.text_of();
  }

 private:
  [[nodiscard]] const ModePlan& mode(std::size_t i) const { return plan_.modes[i]; }
  [[nodiscard]] double x_px(double hz) const noexcept {
    return kLeftPx + (kWidthPx - kLeftPx - kRightPx) * hz / half_hz_;
  }

  void place_labels() {
    for (const std::size_t i : order_) {
      labels_.push_back(
          fmt::format("{}: {:.4g}{}", i + 1, input_.modes[i].frequency_hz, mode(i).place.n != 0 ? "*" : ""));
      const double half = app::text_width_px(labels_.back(), app::kTextPx) / 2.0;
      label_x_px_.push_back(std::clamp(x_px(mode(i).place.apparent_hz), kLeftPx + half, kWidthPx - half - 6.0));
    }
    rows_ = app::label_rows(label_x_px_, labels_, kMaxRows);
    for (const int row : rows_) n_rows_ = std::max(n_rows_, row + 1);
  }

  // Of the mode alone, without the noise floor.
  [[nodiscard]] double peak(std::size_t i) const {
    const double rms = input_.modes[i].rms_mm.value_or(mode(i).least_rms_mm);
    const auto& m = input_.modes[i];
    return core::planning::peak_density(rms * mode(i).exposure_gain, m.damping_ratio, m.frequency_hz,
                                        plan_.bandwidth_hz);
  }
  // The resonances' displacement under white forces, widened by the window, aliased by sampling.
  [[nodiscard]] double density(double hz) const {
    constexpr int kBranches = 3;
    double sum = floor_;
    for (const std::size_t i : order_) {
      if (!std::isfinite(mode(i).least_rms_mm)) continue;
      const double f0 = input_.modes[i].frequency_hz;
      const double zeta = input_.modes[i].damping_ratio + 0.3 * plan_.bandwidth_hz / f0;
      const double height = peak(i) * std::pow(2.0 * zeta, 2);
      const double fold_hz = mode(i).place.n * input_.camera.rate_hz;
      for (int k = -kBranches; k <= kBranches; ++k) {
        const double ratio = (hz + fold_hz + k * input_.camera.rate_hz) / f0;
        sum += height / (std::pow(1.0 - ratio * ratio, 2) + std::pow(2.0 * zeta * ratio, 2));
      }
    }
    return sum;
  }

  void draw_spectrum(app::SvgDocument& svg, const Box& box) {
    std::vector<PlotPoint> curve;
    double highest = 30.0 * floor_;
    for (int k = 0; k <= kSpectrumPoints; ++k) {
      const double hz = half_hz_ * k / kSpectrumPoints;
      curve.push_back({hz, density(hz)});
      highest = std::max(highest, curve.back().y);
    }
    app::PlotPanel panel(svg, box, {0.0, half_hz_, false, ""},
                         app::log_axis_around(0.5 * floor_, highest, 12, "displacement, mm²/Hz"));
    panel.draw_x_axis(false, 14);
    panel.draw_y_axis(true, 8);
    draw_hover_band(svg, box);
    panel.draw_frame();
    const std::vector<PlotPoint> floor{{0.0, floor_}, {half_hz_, floor_}};
    const std::vector<PlotPoint> seen{{0.0, 10.0 * floor_}, {half_hz_, 10.0 * floor_}};
    panel.curve(floor, "k6");
    panel.curve(seen, "k6 d2");
    panel.curve(curve, "k5");
    for (const std::size_t i : order_) {
      const double x = panel.x_px(mode(i).place.apparent_hz);
      if (std::isfinite(mode(i).least_rms_mm))
        svg.circle(x, panel.y_px(peak(i) + floor_), 3.5, dot_of(mode(i).place.outlook));
    }
    draw_labels(svg, box);
    draw_spectrum_legend(svg, box);
  }

  void draw_hover_band(app::SvgDocument& svg, const Box& box) const {
    const double right = x_px(std::min(core::planning::kHoverBandHz, half_hz_));
    for (double x = box.x + 2.0; x < right; x += 3.0) svg.line(x, box.y, x, box.bottom(), "g");
    svg.line(right, box.y, right, box.bottom(), "w");
  }

  void draw_labels(app::SvgDocument& svg, const Box& box) const {
    for (std::size_t k = 0; k < order_.size(); ++k) {
      if (rows_[k] < 0) continue;
      const double y = box.y - 6.0 - kRowPx * rows_[k];
      svg.line(x_px(mode(order_[k]).place.apparent_hz), y + 3.0, x_px(mode(order_[k]).place.apparent_hz), box.y, "z");
    }
    for (std::size_t k = 0; k < order_.size(); ++k) {
      if (rows_[k] < 0) continue;
      const double y = box.y - 6.0 - kRowPx * rows_[k];
      const double half = app::text_width_px(labels_[k], app::kTextPx) / 2.0;
      svg.rect({label_x_px_[k] - half, y - 11.0, 2.0 * half, 13.0}, "b");
      svg.text(label_x_px_[k], y, labels_[k], Anchor::kMiddle);
    }
  }

  void draw_spectrum_legend(app::SvgDocument& svg, const Box& box) const {
    const bool expected = input_.modes.front().rms_mm.has_value();
    const std::vector<app::LegendEntry> entries{{expected ? "expected" : "least amplitude seen", "k5"},
                                                {"noise floor", "k6"},
                                                {"10 dB over it", "k6 d2"},
                                                {"hover drift to 0.5 Hz", "w"}};
    app::draw_legend(svg, {box.right() + 14.0, box.y, kRightPx - 20.0, 80.0}, entries);
    svg.text(box.right() + 14.0, box.bottom() - 8.0, "* folded", Anchor::kStart, "t q");
  }

  void draw_map(app::SvgDocument& svg, const Box& box) {
    const double top_hz = std::max(plan_.max_frequency_hz, half_hz_);
    app::PlotPanel panel(svg, box, {0.0, half_hz_, false, "seen at, Hz"}, {0.0, top_hz, false, "true frequency, Hz"});
    panel.draw_x_axis(true, 14);
    panel.draw_y_axis(true, 6);
    panel.draw_frame();
    std::vector<PlotPoint> branch;
    for (int k = 0; k * half_hz_ < top_hz; ++k) {
      const double from = k * half_hz_, to = std::min(top_hz, from + half_hz_);
      if (branch.empty()) branch.push_back({0.0, 0.0});
      branch.push_back({k % 2 == 0 ? to - from : half_hz_ - (to - from), to});
    }
    panel.curve(branch, "k5");
    for (const std::size_t i : order_) draw_mode(svg, panel, i);
    draw_map_legend(svg, box);
  }

  // The mode's position on the alias map, a line up to the spectrum, and open circles at the rival frequencies.
  void draw_mode(app::SvgDocument& svg, app::PlotPanel& panel, std::size_t i) const {
    const core::planning::FoldPlace& place = mode(i).place;
    const double x = panel.x_px(place.apparent_hz), y = panel.y_px(input_.modes[i].frequency_hz);
    const double nearest = place.rivals_hz.empty() ? 0.0 : place.rivals_hz.back();
    const double top_y = std::min(y, nearest > 0.0 ? panel.y_px(nearest) : y);
    svg.line(x, panel.box().y, x, top_y, "z");
    if (top_y < y) svg.line(x, top_y, x, y, "w");
    for (const double rival_hz : place.rivals_hz) svg.circle(x, panel.y_px(rival_hz), 3.0, "b x");
    svg.circle(x, y, 4.5, dot_of(place.outlook));
    const bool at_right = x > panel.box().right() - 30.0;
    svg.text(at_right ? x - 8.0 : x + 8.0, y - 3.0, fmt::format("{}", i + 1), at_right ? Anchor::kEnd : Anchor::kStart,
             "s");
  }

  void draw_map_legend(app::SvgDocument& svg, const Box& box) const {
    const double x = box.right() + 14.0;
    double y = box.y + 12.0;
    const std::pair<const char*, const char*> kinds[] = {
        {"m0", "at its own place"}, {"m2", "resolved by row delays"}, {"m1", "stays open"}, {"b x", "could also be"}};
    for (const auto& [css_class, label] : kinds) {
      svg.circle(x + 9.0, y - 4.0, 4.5, css_class);
      svg.text(x + 22.0, y, label);
      y += 16.0;
    }
    for (const auto& overlap : plan_.overlaps) {
      y += 16.0;
      if (y > box.bottom()) return;
      svg.text(x, y, fmt::format("{} and {} overlap", overlap.first + 1, overlap.second + 1), Anchor::kStart, "t q");
    }
  }

  const PlanInput& input_;
  const HoverPlan& plan_;
  std::vector<std::size_t> order_;  // modes by apparent frequency
  double half_hz_ = 0.0, floor_ = 0.0;
  std::vector<std::string> labels_;
  std::vector<double> label_x_px_;
  std::vector<int> rows_;
  int n_rows_ = 1;
};

}  // namespace

std::string plan_svg(const PlanInput& input, const HoverPlan& plan) { return PlanPicture(input, plan).draw(); }

}  // namespace tools
