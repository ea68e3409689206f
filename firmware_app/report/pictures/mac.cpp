#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/identification/mac.h"
#include "firmware_app/report/pictures/parts.h"

namespace app {
namespace {

constexpr double kTopPx = 22.0;
constexpr double kMostCellPx = 54.0;
constexpr double kLeastNumberPx = 26.0;  // narrower cells hold no number
constexpr double kFullOpacity = 0.45;    // the number on it stays readable, in light and dark mode

void draw_cell(SvgDocument& svg, const Box& cell, double value) {
  svg.begin_group(fmt::format("fill-opacity=\"{:.2f}\"", std::isfinite(value) ? kFullOpacity * value : 0.0));
  svg.rect(cell, "m0");
  svg.end_group();
  if (cell.width >= kLeastNumberPx)
    svg.text(cell.x + cell.width / 2.0, cell.y + cell.height / 2.0 + 4.0, decimals_text(value, 2), Anchor::kMiddle,
             "s");
}

}  // namespace

double mac_of(const core::Mode& a, const core::Mode& b) {
  std::vector<std::complex<double>> of_a, of_b;
  for (std::size_t c = 0; c < a.shape.size() && c < b.shape.size(); ++c) {
    if (!std::isfinite(std::abs(a.shape[c])) || !std::isfinite(std::abs(b.shape[c]))) continue;
    of_a.push_back(a.shape[c]), of_b.push_back(b.shape[c]);
  }
  return core::mac(of_a, of_b);
}

std::string mac_svg(const PictureInputs& inputs, const PictureFormat& format) {
  if (inputs.estimate == nullptr || inputs.estimate->modes.size() < 2) return {};
  const std::vector<core::Mode>& modes = inputs.estimate->modes;
  const std::size_t n = std::min(modes.size(), kMaxMacModes);
  const double left = is_narrow(format) ? 64.0 : 92.0;
  const double cell = std::min(kMostCellPx, (format.width_px - left - 8.0) / static_cast<double>(n));
  SvgDocument svg(format.width_px, kTopPx + cell * static_cast<double>(n) + 4.0, "MAC of every pair of modes", true);
  for (std::size_t i = 0; i < n; ++i) {
    const double at = (static_cast<double>(i) + 0.5) * cell;
    svg.text(left + at, kTopPx - 7.0, std::to_string(i + 1), Anchor::kMiddle, "s");
    const std::string frequency = four_digits_text(modes[i].frequency_hz);
    svg.text(left - 6.0, kTopPx + at + 4.0, is_narrow(format) ? frequency : fmt::format("{}: {} Hz", i + 1, frequency),
             Anchor::kEnd, "s");
    for (std::size_t j = 0; j < n; ++j) {
      const Box box{left + cell * static_cast<double>(j), kTopPx + cell * static_cast<double>(i), cell, cell};
      draw_cell(svg, box, mac_of(modes[i], modes[j]));
    }
  }
  svg.rect({left, kTopPx, cell * static_cast<double>(n), cell * static_cast<double>(n)}, "x");
  return svg.text_of();
}

}  // namespace app
