#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "firmware_app/report/pictures/parts.h"
#include "firmware_app/report/plot/mode_plot.h"
#include "firmware_app/report/plot/svg_plot.h"

namespace app {
namespace {

constexpr std::size_t kMaxModes = 28;
constexpr std::size_t kMaxMarkers = 2'000;  // of all modes together: keeps the file below 500 kB
constexpr double kPanelTitlePx = 58.0;      // three lines above a panel

class ModesPicture {
 public:
  ModesPicture(const std::vector<core::Mode>& modes, const ModeLayout& layout) : modes_(modes), layout_(layout) {
    const std::size_t n_channels = std::max<std::size_t>(1, layout.lines[0].size() + layout.lines[1].size());
    n_shown_ = std::min({modes.size(), kMaxModes, std::max<std::size_t>(1, kMaxMarkers / n_channels)});
    for (const auto& line : layout.lines) {
      for (const ModePlace& place : line)
        names_px_ = std::max(names_px_, text_width_px(place.name, kSmallTextPx) + 24.0);
    }
    const std::size_t most = layout.upright ? 6 : 3;
    n_columns_ = std::min(n_shown_, most);
    panel_width_ = layout.upright ? 150.0 : 280.0;
    panel_height_ = layout.upright ? 300.0 : 120.0;
    if (!layout.upright) names_px_ = 46.0;
  }

  [[nodiscard]] std::string draw() const {
    const std::size_t n_rows = (n_shown_ + n_columns_ - 1) / n_columns_;
    const double width = std::max(420.0, names_px_ + static_cast<double>(n_columns_) * column_step() + 4.0);
    SvgDocument svg(width, 44.0 + static_cast<double>(n_rows) * row_step(), "Mode shapes");
    svg.text(14.0, 24.0, "Mode shapes", Anchor::kStart, "h");
    const bool two = !layout_.lines[0].empty() && !layout_.lines[1].empty();
    if (two) svg.text(124.0, 24.0, "solid: along u, dashed: along v", Anchor::kStart, "s q");
    if (n_shown_ < modes_.size()) {
      svg.text(width - 14.0, 24.0, fmt::format("and {} more", modes_.size() - n_shown_), Anchor::kEnd, "t q");
    }
    for (std::size_t i = 0; i < n_shown_; ++i) draw_mode(svg, i);
    return svg.text_of();
  }

 private:
  [[nodiscard]] double column_step() const noexcept { return panel_width_ + (layout_.upright ? 18.0 : 36.0); }
  [[nodiscard]] double row_step() const noexcept {
    return kPanelTitlePx + panel_height_ + (layout_.upright ? 30.0 : 44.0);
  }

  void draw_mode(SvgDocument& svg, std::size_t i) const {
    const core::Mode& mode = modes_[i];
    const std::size_t i_column = i % n_columns_, i_row = i / n_columns_;
    const Box box{names_px_ + static_cast<double>(i_column) * column_step(),
                  44.0 + kPanelTitlePx + static_cast<double>(i_row) * row_step(), panel_width_, panel_height_};
    draw_title(svg, box, mode);
    draw_mode_plot(svg, {box, layout_.low_px, layout_.high_px, i_column == 0 || !layout_.upright}, layout_, mode);
  }

  static void draw_title(SvgDocument& svg, const Box& box, const core::Mode& mode) {
    const double x = box.x + box.width / 2.0;
    std::string frequency = four_digits_text(mode.frequency_hz);
    if (mode.frequency_std_hz) frequency += " ± " + decimals_text(*mode.frequency_std_hz, 3);
    std::string damping = "damping " + decimals_text(100.0 * mode.damping_ratio, 2);
    if (mode.damping_std) damping += " ± " + decimals_text(100.0 * *mode.damping_std, 2);
    svg.text(x, box.y - 41.0, frequency + " Hz", Anchor::kMiddle);
    svg.text(x, box.y - 25.0, damping + " %", Anchor::kMiddle, "s");
    std::string quality = "MPC " + decimals_text(mode.mpc, 3);
    if (is_folded(mode)) quality += fmt::format(", seen at {} Hz", four_digits_text(mode.apparent_hz));
    svg.text(x, box.y - 9.0, quality, Anchor::kMiddle, "s");
  }

  const std::vector<core::Mode>& modes_;
  const ModeLayout& layout_;
  std::size_t n_shown_ = 0, n_columns_ = 1;
  double names_px_ = 60.0, panel_width_ = 0.0, panel_height_ = 0.0;
};

std::string no_modes(const core::ModalEstimate& estimate) {
  SvgDocument svg(600.0, 120.0, "Mode shapes");
  svg.text(14.0, 24.0, "Mode shapes", Anchor::kStart, "h");
  svg.text(300.0, 64.0, "no modes", Anchor::kMiddle);
  if (estimate.status != "ok") svg.text(300.0, 84.0, shortened(estimate.status, 90), Anchor::kMiddle, "s q");
  return svg.text_of();
}

}  // namespace

std::string modes_svg(const PictureInputs& inputs) {
  if (inputs.estimate == nullptr || inputs.channels.empty()) return {};
  if (inputs.estimate->modes.empty()) return no_modes(*inputs.estimate);
  const ModeLayout layout = mode_layout(inputs);
  return ModesPicture(inputs.estimate->modes, layout).draw();
}

}  // namespace app
