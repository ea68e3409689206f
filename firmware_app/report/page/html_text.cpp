#include "firmware_app/report/page/html_text.h"

#include <fmt/format.h>

#include "firmware_app/report/plot/svg_document.h"

namespace app {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) -> unsigned {
      return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
    };
    const unsigned word = byte(0) << 16U | byte(1) << 8U | byte(2);
    for (unsigned k = 0; k < 4; ++k) out += k <= bytes.size() - i ? kDigits[(word >> (18U - 6U * k)) & 63U] : '=';
  }
  return out;
}

std::string section_html(std::string_view id, std::string_view title, const std::string& html) {
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, svg_escaped(title), html);
}

std::string paragraph_html(std::string_view text, std::string_view css_class) {
  if (css_class.empty()) return fmt::format("<p>{}</p>\n", svg_escaped(text));
  return fmt::format("<p class=\"{}\">{}</p>\n", css_class, svg_escaped(text));
}

std::string absent_html(std::string_view text) { return paragraph_html(text, "absent"); }

std::string merged_html(std::string_view what) {
  return absent_html(fmt::format(
      "A merged result has no {} of its own, because its set-ups were not measured at the same time. Each set-up has: "
      "identify its file alone, without --merge.",
      what));
}

std::string figure_html(const std::string& wide_svg, const std::string& narrow_svg, const std::string& above,
                        const std::string& below) {
  return fmt::format(
      "<figure>\n{}<div class=\"plot wide\">{}</div>\n<div class=\"plot narrow\">{}</div>\n{}</figure>\n", above,
      wide_svg, narrow_svg, below.empty() ? std::string() : fmt::format("<figcaption>{}</figcaption>\n", below));
}

HtmlTable::HtmlTable(std::vector<std::string> columns, std::string_view css_class)
    : columns_(std::move(columns)), css_class_(css_class) {}

void HtmlTable::add(std::vector<HtmlCell> cells) {
  rows_ += "<tr>";
  for (std::size_t i = 0; i < cells.size() && i < columns_.size(); ++i) {
    const char* tag = i == 0 ? "th scope=\"row\"" : "td";
    rows_ += fmt::format("<{} data-label=\"{}\">{}{}</{}>", tag, svg_escaped(columns_[i]), svg_escaped(cells[i].text),
                         cells[i].html, i == 0 ? "th" : "td");
  }
  rows_ += "</tr>\n";
}

std::string HtmlTable::html() const {
  std::string head;
  for (const std::string& column : columns_) head += fmt::format("<th scope=\"col\">{}</th>", svg_escaped(column));
  const std::string css_class = css_class_.empty() ? std::string() : fmt::format(" class=\"{}\"", css_class_);
  return fmt::format("<table{}>\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n</table>\n", css_class, head, rows_);
}

}  // namespace app
