// The structure to scale, with what was found marked.
#include <algorithm>
#include <limits>

#include "firmware_app/report/plot/svg_document.h"
#include "firmware_app/report/structure_pictures.h"

namespace app {
namespace {

constexpr double kDrawingPx = 760.0, kMostWide = 420.0, kMostHigh = 380.0, kLeft = 60.0, kTopPx = 84.0, kLabelPx = 38.0;
constexpr std::size_t kMostLabels = 12;

// From metres to pixels, the same in both directions.
struct Scale {
  double low_x = std::numeric_limits<double>::infinity(), high_x = -low_x, low_z = low_x, high_z = -low_x;
  double px_per_m = 1.0;

  explicit Scale(const std::vector<DrawnPart>& parts) {
    for (const DrawnPart& part : parts) {
      low_x = std::min({low_x, part.from_x, part.to_x}), high_x = std::max({high_x, part.from_x, part.to_x});
      low_z = std::min({low_z, part.from_z, part.to_z}), high_z = std::max({high_z, part.from_z, part.to_z});
    }
    px_per_m = std::min(kMostWide / std::max(high_x - low_x, 1e-12), kMostHigh / std::max(high_z - low_z, 1e-12));
  }
  [[nodiscard]] double x(double m) const { return kLeft + (m - low_x) * px_per_m; }
  [[nodiscard]] double z(double m) const { return kTopPx + (high_z - m) * px_per_m; }
  [[nodiscard]] double bottom() const { return z(low_z); }
};

void draw_part(SvgDocument& svg, const Scale& scale, const DrawnPart& part, const char* css_class,
               const char* attributes, Marker marker) {
  const double x1 = scale.x(part.from_x), z1 = scale.z(part.from_z), x2 = scale.x(part.to_x), z2 = scale.z(part.to_z);
  if (x1 == x2 && z1 == z2) {
    svg.marker(x1, z1, marker == Marker::kRing ? 9.0 : 6.0, marker, css_class, {});
  } else {
    svg.line(x1, z1, x2, z2, css_class, attributes);
  }
}

}  // namespace

std::string structure_drawing_svg(const std::vector<DrawnPart>& parts, const std::vector<SeenPlace>& seen) {
  if (parts.empty()) return {};
  const Scale scale(parts);
  const auto n_found = static_cast<double>(
      std::min<std::size_t>(static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(),
                                                                   [](const auto& p) { return !p.found.empty(); })),
                            kMostLabels));
  SvgDocument svg(kDrawingPx, std::max(scale.bottom() + 36.0, kTopPx + kLabelPx * n_found + 24.0), "The structure");
  svg.text(24.0, 24.0, "The structure, and where what was found acts", Anchor::kStart, "h");
  svg.text(24.0, 44.0, "thick or filled: found; dashed or ringed: the modes do not distinguish it (95 %); dots: seen",
           Anchor::kStart, "s q");
  for (const DrawnPart& part : parts) {
    if (part.is_member) draw_part(svg, scale, part, "x", "stroke-width=\"2\"", Marker::kDot);
  }
  for (const SeenPlace& place : seen) svg.marker(scale.x(place.x), scale.z(place.z), 3.0, Marker::kDot, "m2");
  for (const DrawnPart& part : parts) {
    if (part.is_indistinguishable && part.found.empty())
      draw_part(svg, scale, part, "k1 n", "stroke-dasharray=\"4 3\" stroke-width=\"4\"", Marker::kRing);
  }
  double label = kTopPx;
  for (const DrawnPart& part : parts) {
    if (part.found.empty()) continue;
    const bool is_node = part.from_x == part.to_x && part.from_z == part.to_z;
    draw_part(svg, scale, part, is_node ? "m1" : "k1", "stroke-width=\"5\"", Marker::kDiamond);
    if (label > kTopPx + kLabelPx * static_cast<double>(kMostLabels)) continue;
    const double x = scale.x(0.5 * (part.from_x + part.to_x)), z = scale.z(0.5 * (part.from_z + part.to_z));
    svg.line(x, z, kLeft + kMostWide + 14.0, label, "w");
    // The effect, and below it what it is here.
    const std::size_t colon = std::min(part.found.find(": "), part.found.size());
    svg.text(kLeft + kMostWide + 18.0, label + 4.0, shortened(part.found.substr(0, colon), 36));
    if (colon < part.found.size())
      svg.text(kLeft + kMostWide + 18.0, label + 20.0, shortened(part.found.substr(colon + 2), 44), Anchor::kStart,
               "s q");
    label += kLabelPx;
  }
  return svg.text_of();
}

}  // namespace app
