#include "firmware_app/report/plot/mode_labels.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware_app/report/plot/verdict_marks.h"

namespace app {
namespace {

constexpr int kMaxLabelRows = 6;
constexpr double kRailPx = 9.0;  // markers of rejected poles below the panel's upper edge
constexpr double kMarkerPx = 3.6;

std::string label_of(const core::Mode& mode, const PictureFormat& format) {
  if (!is_narrow(format)) return frequency_text(mode, false);
  return four_digits_text(mode.frequency_hz) + (is_folded(mode) ? " Hz, folded" : " Hz");
}

}  // namespace

ModeLabels::ModeLabels(const core::ModalEstimate* estimate, double highest_hz, double box_x_px, double box_width_px,
                       const PictureFormat& format) {
  if (estimate == nullptr) return;
  for (const core::Mode& mode : estimate->modes) {
    if (mode.apparent_hz >= 0.0 && mode.apparent_hz <= highest_hz) modes_.push_back(mode);
  }
  std::stable_sort(modes_.begin(), modes_.end(),
                   [](const auto& a, const auto& b) { return a.apparent_hz < b.apparent_hz; });
  for (const core::Mode& mode : modes_) {
    labels_.push_back(label_of(mode, format));
    const double half = text_width_px(labels_.back(), kTextPx) / 2.0;
    const double x = box_x_px + box_width_px * mode.apparent_hz / highest_hz;
    label_x_px_.push_back(std::clamp(x, half + 4.0, format.width_px - half - 4.0));
  }
  rows_ = label_rows(label_x_px_, labels_, kMaxLabelRows);
  for (const int row : rows_) n_rows_ = std::max(n_rows_, row + 1);
}

void ModeLabels::draw(SvgDocument& svg, const PlotPanel& panel) const {
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const double x = panel.x_px(modes_[i].apparent_hz);
    const double y = panel.box().y - 5.0 - kRowPx * std::max(0, rows_[i]);
    svg.line(x, rows_[i] > 0 ? y + 3.0 : panel.box().y, x, panel.box().bottom(), "v", say_attribute(modes_[i]));
  }
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    if (rows_[i] < 0) continue;
    const double y = panel.box().y - 5.0 - kRowPx * rows_[i];
    const double half = text_width_px(labels_[i], kTextPx) / 2.0;
    svg.rect({label_x_px_[i] - half, y - 11.0, 2.0 * half, 13.0}, "b");  // hides other modes' lines behind the label
    svg.text(label_x_px_[i], y, labels_[i], Anchor::kMiddle);
  }
}

void draw_rejected(SvgDocument& svg, PlotPanel& panel, const core::ModalEstimate* estimate, double highest_hz,
                   const PictureFormat& format) {
  if (estimate == nullptr) return;
  for (const VerdictMark& mark : verdict_marks()) {
    for (const core::Mode& mode : estimate->rejected) {
      const bool inside = mode.apparent_hz >= 0.0 && mode.apparent_hz <= highest_hz;
      if (mode.verdict != mark.verdict || !inside) continue;
      if (mark.verdict != core::Verdict::kNumerical) panel.vertical(mode.apparent_hz, mark.line_class);
      if (!format.on_page) continue;
      svg.marker(panel.x_px(mode.apparent_hz), panel.box().y + kRailPx, kMarkerPx, mark.marker, mark.marker_class,
                 say_attribute(mode));
    }
  }
}

std::string say_attribute(const core::Mode& mode) {
  return fmt::format("data-f=\"{:.6g}\" data-say=\"{}: {}\"", mode.apparent_hz, mark_of(mode.verdict).label,
                     svg_escaped(frequency_text(mode, false)));
}

}  // namespace app
