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
inline constexpr double kSmallTextPx = 12.0;  // ticks and remarks: still readable on a phone
inline constexpr double kTitlePx = 14.0;

// Fit for the text of an XML element or attribute: markup escaped, control characters and broken UTF-8 made '?'.
[[nodiscard]] std::string svg_escaped(std::string_view text);
// At most one decimal, the same bytes on every machine; "0" for what is not finite.
[[nodiscard]] std::string svg_number(double value);
[[nodiscard]] std::string power_of_ten_text(int exponent);  // "10⁻³"
// Width of sans-serif text, estimated: there is no font to ask.
[[nodiscard]] double text_width_px(std::string_view text, double height_px) noexcept;
// At most `max_characters`; cut text ends in an ellipsis.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t max_characters);
// The same, keeping both ends: names often differ in their last characters only.
[[nodiscard]] std::string shortened_inside(std::string_view text, std::size_t max_characters);

// Classes of the style sheet that every drawing carries: the colours of Okabe and Ito (told apart with every kind of
// colour vision) in two sets, for light and for dark surroundings. After seven lines the dashes change.
[[nodiscard]] std::string line_class(std::size_t i_line);
[[nodiscard]] std::string fill_class(std::size_t i_line);

// Shapes for points, so that no meaning hangs on colour alone.
enum class Marker { kDot, kRing, kSquare, kDiamond, kTriangle, kCross };

// Style sheet of a page that takes drawings in; a drawing in a file of its own carries it.
[[nodiscard]] std::string_view svg_style() noexcept;

// One SVG picture, built from front to back in pixels, y down. No scripts, nothing external. Identical calls give
// identical bytes. Coordinates are rounded to 0.1 px.
class SvgDocument {
 public:
  // `on_page`: an element of an HTML page, as wide as its place there, without style sheet and background.
  SvgDocument(double width_px, double height_px, std::string_view title, bool on_page = false);

  void line(double x1, double y1, double x2, double y2, std::string_view css_class, std::string_view attributes = {});
  void rect(const Box& box, std::string_view css_class, double corner_px = 0.0);
  void circle(double x, double y, double radius, std::string_view css_class);
  // A path through the points; gaps split it, a point between two gaps becomes a dot.
  void path(std::span<const PlotPoint> points, std::string_view css_class, std::string_view attributes = {});
  void marker(double x, double y, double radius, Marker marker, std::string_view css_class,
              std::string_view attributes = {});
  // `css_class` "t" for text, "s" for small, "h" for titles, each with " q" when it should stand back.
  void text(double x, double y, std::string_view text, Anchor anchor = Anchor::kStart,
            std::string_view css_class = "t");
  void text_upwards(double x, double y, std::string_view text);  // turned a quarter to the left, centred
  // `attributes` here and above: well-formed XML of our own making, e.g. `data-k="3"`.
  void begin_clip(const Box& box);  // a drawing of its own, whose origin is the box's corner; ends with end_clip()
  void end_clip();
  void begin_group(std::string_view attributes);
  void end_group();
  void use(std::string_view id, double x, double y, double scale);  // an element of the page, by its id

  [[nodiscard]] std::string text_of() const { return out_ + "</svg>\n"; }

 private:
  void begin_text(double x, double y, Anchor anchor, std::string_view css_class);
  std::string out_;
};

}  // namespace app
