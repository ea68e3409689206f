#pragma once

#include <span>
#include <string>
#include <string_view>

namespace app {

struct PlotPoint {
  double x = 0.0;
  double y = 0.0;  // NaN in either: a gap
};

struct Box {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
  [[nodiscard]] double right() const noexcept { return x + width; }
  [[nodiscard]] double bottom() const noexcept { return y + height; }
};

[[nodiscard]] inline bool overlap(const Box& a, const Box& b) noexcept {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

enum class Anchor { kStart, kMiddle, kEnd };

inline constexpr double kTextPx = 12.0;       // height of ordinary text
inline constexpr double kSmallTextPx = 12.0;  // ticks and remarks: large enough to read on a phone
inline constexpr double kTitlePx = 14.0;

// Converts any text for use in an XML element or attribute: markup escaped, control characters and invalid UTF-8 made
// '?'.
[[nodiscard]] std::string svg_escaped(std::string_view text);
// At most one decimal, the same bytes on every machine; "0" for values that are not finite.
[[nodiscard]] std::string svg_number(double value);
[[nodiscard]] std::string power_of_ten_text(int exponent);  // "10⁻³"
// Estimated width of sans-serif text, without access to a font.
[[nodiscard]] double text_width_px(std::string_view text, double height_px) noexcept;
// At most `max_characters`; cut text ends in an ellipsis.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t max_characters);
// The same, keeping both ends, because names often differ only in their last characters.
[[nodiscard]] std::string shortened_inside(std::string_view text, std::size_t max_characters);

// Classes of the style sheet that every drawing carries: the colours of Okabe and Ito (distinguishable with every kind
// of colour vision) in two sets, for light and for dark backgrounds. After seven lines the dash pattern changes.
[[nodiscard]] std::string line_class(std::size_t i_line);
[[nodiscard]] std::string fill_class(std::size_t i_line);

// Shapes of points, so that no meaning depends on colour alone.
enum class Marker { kDot, kRing, kSquare, kDiamond, kTriangle, kCross };

// Style sheet for a page that embeds drawings; a drawing in its own file contains it.
[[nodiscard]] std::string_view svg_style() noexcept;

// One SVG picture, built from front to back in pixels, y down. No scripts, nothing external. Identical calls give
// identical bytes. Coordinates are rounded to 0.1 px.
class SvgDocument {
 public:
  // `on_page`: an element of an HTML page, as wide as its container, without style sheet and background.
  SvgDocument(double width_px, double height_px, std::string_view title, bool on_page = false);

  void line(double x1, double y1, double x2, double y2, std::string_view css_class, std::string_view attributes = {});
  void rect(const Box& box, std::string_view css_class, double corner_px = 0.0);
  void circle(double x, double y, double radius, std::string_view css_class);
  // A path through the points; gaps split it, a point between two gaps becomes a dot.
  void path(std::span<const PlotPoint> points, std::string_view css_class, std::string_view attributes = {});
  void marker(double x, double y, double radius, Marker marker, std::string_view css_class,
              std::string_view attributes = {});
  // `css_class` "t" for text, "s" for small, "h" for titles, each with " q" for less contrast.
  void text(double x, double y, std::string_view text, Anchor anchor = Anchor::kStart,
            std::string_view css_class = "t");
  void text_upwards(double x, double y, std::string_view text);  // rotated by 90 degrees to the left, centred
  // `attributes` here and above: well-formed XML from this program, e.g. `data-k="3"`.
  void begin_clip(const Box& box);  // clips to the box, whose corner becomes the origin; ended by end_clip()
  void end_clip();
  void begin_group(std::string_view attributes);
  void end_group();
  void use(std::string_view id, double x, double y, double scale);  // refers to an element of the page by its id

  [[nodiscard]] std::string text_of() const { return out_ + "</svg>\n"; }

 private:
  void begin_text(double x, double y, Anchor anchor, std::string_view css_class);
  std::string out_;
};

}  // namespace app
