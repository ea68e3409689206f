#include "firmware_app/report/plot/svg_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include "drivers/storage/printable.h"

namespace app {
namespace {

constexpr std::size_t kColors = 7;
constexpr std::size_t kDashes = 4;

// Scoped by the class of the root, so that a page which embeds the drawing is not restyled.
constexpr std::string_view kStyle =
    ".hm text{font-family:sans-serif;font-size:12px;fill:#222}"
    ".hm .h{font-size:14px;font-weight:bold}.hm .q{fill:#666}"
    ".hm path{fill:none;stroke-width:1.2;stroke-linecap:round;stroke-linejoin:round}"
    ".hm .b{fill:#fff}.hm .g{stroke:#e2e2e2}.hm .z{stroke:#aaa}.hm .x{fill:none;stroke:#888}"
    ".hm .v{stroke:#222;stroke-dasharray:5 3}.hm .w{stroke:#999;stroke-dasharray:1.5 3}"
    ".hm .w.i{stroke:#d55e00;stroke-opacity:.7}.hm .w.o{stroke:#cc79a7}"
    ".hm .behind{stroke:#bbb;stroke-width:1.4}.hm .n{fill:none;stroke-width:1.6}"
    ".hm .w.u{stroke:#e69f00;stroke-dasharray:6 2 1 2}.hm .d1{stroke-dasharray:6 3}.hm .d2{stroke-dasharray:2 3}.hm "
    ".d3{stroke-dasharray:8 3 2 3}"
    ".hm .k0{stroke:#0072b2}.hm .k1{stroke:#d55e00}.hm .k2{stroke:#009e73}.hm .k3{stroke:#e69f00}"
    ".hm .k4{stroke:#cc79a7}.hm .k5{stroke:#56b4e9}.hm .k6{stroke:#000}"
    ".hm .m0{fill:#0072b2}.hm .m1{fill:#d55e00}.hm .m2{fill:#009e73}.hm .m3{fill:#e69f00}"
    ".hm .k7{stroke:#777}.hm .m7{fill:#777}.hm .m4{fill:#cc79a7}.hm .m5{fill:#56b4e9}.hm .m6{fill:#000}"
    "@media(prefers-color-scheme:dark){.hm text{fill:#e6e6e6}.hm .q{fill:#aaa}.hm .b{fill:#16191d}"
    ".hm .g{stroke:#2c3137}.hm .z{stroke:#666}.hm .v{stroke:#e6e6e6}.hm .w{stroke:#777}"
    ".hm .behind{stroke:#555}.hm .k7{stroke:#999}.hm .m7{fill:#999}.hm .k0{stroke:#56b4e9}.hm .k5{stroke:#f0e442}.hm "
    ".k6{stroke:#fff}"
    ".hm .m0{fill:#56b4e9}.hm .m5{fill:#f0e442}.hm .m6{fill:#fff}}\n";

// Bytes of the UTF-8 character that begins here; 0 = invalid.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  const unsigned char second = byte(1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool outside = (lead == 0xED && second >= 0xA0) || (lead == 0xF4 && second >= 0x90);  // surrogates, > U+10FFFF
  const bool no_character = lead == 0xEF && second == 0xBF && byte(2) >= 0xBE;                // U+FFFE, U+FFFF
  return overlong || outside || no_character ? 0 : length;
}

// Tenths of a pixel. Very large values are clipped: they lie outside every picture.
std::int64_t tenths(double value) {
  return std::isfinite(value) ? std::llround(std::clamp(value, -1e6, 1e6) * 10.0) : 0;
}

void append_tenths(std::string& out, std::int64_t value) {
  if (value < 0) out += '-';
  const std::int64_t magnitude = std::abs(value);
  if (magnitude >= 10 || magnitude == 0) out += fmt::format_int(magnitude / 10).c_str();
  if (magnitude % 10 == 0) return;
  out += '.';
  out += static_cast<char>('0' + magnitude % 10);
}

// A separator is needed only where the next number does not begin with its own sign.
void append_pair(std::string& out, std::int64_t x, std::int64_t y) {
  append_tenths(out, x);
  if (y >= 0) out += ' ';
  append_tenths(out, y);
}

std::string_view to_text(Anchor anchor) {
  switch (anchor) {
    case Anchor::kStart:
      return "start";
    case Anchor::kMiddle:
      return "middle";
    case Anchor::kEnd:
      return "end";
  }
  return "start";
}

}  // namespace

std::string svg_escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const char c = text.front();
    if (length > 1 && drivers::printable_length(text) == 0) {
      out += '?';  // would change the direction of writing, or hide
    } else if (length > 1) {
      out += text.substr(0, length);
    } else if (length == 0 || static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      out += '?';
    } else if (c == '&' || c == '<' || c == '>' || c == '"' || c == '\'') {
      out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : "&#39;";
    } else {
      out += c;
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

std::string svg_number(double value) {
  std::string out;
  append_tenths(out, tenths(value));
  return out;
}

double text_width_px(std::string_view text, double height_px) noexcept {
  const auto n =
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
  return 0.58 * height_px * static_cast<double>(n);
}

std::string power_of_ten_text(int exponent) {
  constexpr std::array<const char*, 10> kSuperscripts{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent)))
    out += kSuperscripts[static_cast<std::size_t>(digit - '0')];
  return out;
}

std::string shortened(std::string_view text, std::size_t max_characters) {
  std::size_t at = 0;
  for (std::size_t n = 0; at < text.size(); ++n) {
    if (n + 1 == max_characters && at + std::max<std::size_t>(character_length(text.substr(at)), 1) < text.size()) {
      return std::string(text.substr(0, at)) + "…";
    }
    at += std::max<std::size_t>(character_length(text.substr(at)), 1);
  }
  return std::string(text);
}

std::string shortened_inside(std::string_view text, std::size_t max_characters) {
  std::vector<std::size_t> starts;  // of the characters
  for (std::size_t at = 0; at < text.size(); at += std::max<std::size_t>(character_length(text.substr(at)), 1))
    starts.push_back(at);
  if (starts.size() <= max_characters || max_characters < 3) return shortened(text, max_characters);
  const std::size_t n_front = (max_characters - 1) / 2, n_back = max_characters - 1 - n_front;
  return std::string(text.substr(0, starts[n_front])) + "…" + std::string(text.substr(starts[starts.size() - n_back]));
}

std::string line_class(std::size_t i_line) {
  const std::size_t dash = i_line / kColors % kDashes;
  return dash == 0 ? fmt::format("k{}", i_line % kColors) : fmt::format("k{} d{}", i_line % kColors, dash);
}

std::string fill_class(std::size_t i_line) { return fmt::format("m{}", i_line % kColors); }

std::string_view svg_style() noexcept { return kStyle; }

SvgDocument::SvgDocument(double width_px, double height_px, std::string_view title, bool on_page) {
  const std::string width = svg_number(width_px), height = svg_number(height_px);
  if (on_page) {
    out_ = fmt::format("<svg class=\"hm\" role=\"img\" viewBox=\"0 0 {} {}\" aria-label=\"{}\">\n", width, height,
                       svg_escaped(title));
    return;
  }
  out_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"hm\" role=\"img\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\">\n<title>{2}</title>\n<style>{3}</style>\n",
      width, height, svg_escaped(title), kStyle);
  rect({0.0, 0.0, width_px, height_px}, "b", 8.0);
}

void SvgDocument::line(double x1, double y1, double x2, double y2, std::string_view css_class,
                       std::string_view attributes) {
  fmt::format_to(std::back_inserter(out_), "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" class=\"{}\"{}{}/>\n",
                 svg_number(x1), svg_number(y1), svg_number(x2), svg_number(y2), css_class,
                 attributes.empty() ? "" : " ", attributes);
}

void SvgDocument::rect(const Box& box, std::string_view css_class, double corner_px) {
  const std::string corner = corner_px > 0.0 ? fmt::format(" rx=\"{}\"", svg_number(corner_px)) : std::string();
  fmt::format_to(std::back_inserter(out_), "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{} class=\"{}\"/>\n",
                 svg_number(box.x), svg_number(box.y), svg_number(box.width), svg_number(box.height), corner,
                 css_class);
}

void SvgDocument::circle(double x, double y, double radius, std::string_view css_class) {
  fmt::format_to(std::back_inserter(out_), "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" class=\"{}\"/>\n", svg_number(x),
                 svg_number(y), svg_number(radius), css_class);
}

void SvgDocument::path(std::span<const PlotPoint> points, std::string_view css_class, std::string_view attributes) {
  std::string data;
  std::int64_t last_x = 0, last_y = 0;
  enum { kGap, kMoved, kDrawn } state = kGap;
  const auto end_run = [&] {
    if (state == kMoved) data += "h0";  // round caps make it a dot
    state = kGap;
  };
  for (const PlotPoint& point : points) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      end_run();
      continue;
    }
    const std::int64_t x = tenths(point.x), y = tenths(point.y);
    if (state == kGap) {
      data += 'M';
      append_pair(data, x, y);
      state = kMoved;
    } else if (x != last_x || y != last_y) {
      data += 'l';
      append_pair(data, x - last_x, y - last_y);
      state = kDrawn;
    }
    last_x = x, last_y = y;
  }
  end_run();
  if (data.empty()) return;
  fmt::format_to(std::back_inserter(out_), "<path class=\"{}\"{}{} d=\"{}\"/>\n", css_class,
                 attributes.empty() ? "" : " ", attributes, data);
}

void SvgDocument::marker(double x, double y, double radius, Marker marker, std::string_view css_class,
                         std::string_view attributes) {
  const double r = radius;
  const auto polygon = [&](std::initializer_list<PlotPoint> corners) {
    std::vector<PlotPoint> points(corners);
    if (marker != Marker::kCross) points.push_back(points.front());
    for (PlotPoint& point : points) point.x += x, point.y += y;
    path(points, css_class, attributes);
  };
  switch (marker) {
    case Marker::kDot:
    case Marker::kRing:
      fmt::format_to(std::back_inserter(out_), "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" class=\"{}\"{}{}/>\n",
                     svg_number(x), svg_number(y), svg_number(r), css_class, attributes.empty() ? "" : " ", attributes);
      return;
    case Marker::kSquare:
      return polygon({{-r, -r}, {r, -r}, {r, r}, {-r, r}});
    case Marker::kDiamond:
      return polygon({{0.0, -1.3 * r}, {1.3 * r, 0.0}, {0.0, 1.3 * r}, {-1.3 * r, 0.0}});
    case Marker::kTriangle:
      return polygon({{-1.1 * r, r}, {1.1 * r, r}, {0.0, -1.1 * r}});
    case Marker::kCross:
      return polygon({{-r, -r}, {r, r}, {std::numeric_limits<double>::quiet_NaN(), 0.0}, {-r, r}, {r, -r}});
  }
}

void SvgDocument::begin_group(std::string_view attributes) {
  fmt::format_to(std::back_inserter(out_), "<g {}>\n", attributes);
}

void SvgDocument::end_group() { out_ += "</g>\n"; }

void SvgDocument::begin_clip(const Box& box) {
  fmt::format_to(std::back_inserter(out_), "<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">\n", svg_number(box.x),
                 svg_number(box.y), svg_number(box.width), svg_number(box.height));
}

void SvgDocument::end_clip() { out_ += "</svg>\n"; }

void SvgDocument::use(std::string_view id, double x, double y, double scale) {
  fmt::format_to(std::back_inserter(out_), "<use href=\"#{}\" transform=\"translate({} {}) scale({:.5f})\"/>\n", id,
                 svg_number(x), svg_number(y), scale);
}

void SvgDocument::begin_text(double x, double y, Anchor anchor, std::string_view css_class) {
  fmt::format_to(std::back_inserter(out_), "<text x=\"{}\" y=\"{}\"", svg_number(x), svg_number(y));
  if (anchor != Anchor::kStart) fmt::format_to(std::back_inserter(out_), " text-anchor=\"{}\"", to_text(anchor));
  fmt::format_to(std::back_inserter(out_), " class=\"{}\"", css_class);
}

void SvgDocument::text(double x, double y, std::string_view text, Anchor anchor, std::string_view css_class) {
  begin_text(x, y, anchor, css_class);
  fmt::format_to(std::back_inserter(out_), ">{}</text>\n", svg_escaped(text));
}

void SvgDocument::text_upwards(double x, double y, std::string_view text) {
  begin_text(x, y, Anchor::kMiddle, "t");
  fmt::format_to(std::back_inserter(out_), " transform=\"rotate(-90 {} {})\">{}</text>\n", svg_number(x), svg_number(y),
                 svg_escaped(text));
}

}  // namespace app
