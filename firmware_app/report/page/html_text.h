#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace app {

// Pieces of an HTML page that is also well-formed XML, bar its doctype. `text` parameters are escaped here; `html` ones
// are markup of our own making.

[[nodiscard]] std::string base64(std::string_view bytes);

[[nodiscard]] std::string section_html(std::string_view id, std::string_view title, const std::string& html);
[[nodiscard]] std::string paragraph_html(std::string_view text, std::string_view css_class = {});
// Why a section has nothing to show.
[[nodiscard]] std::string absent_html(std::string_view text);

// A picture in its two widths, of which the page's style shows one. `above` and `below`: html, e.g. a legend.
[[nodiscard]] std::string figure_html(const std::string& wide_svg, const std::string& narrow_svg,
                                      const std::string& above, const std::string& below);

struct HtmlCell {
  std::string text;
  std::string html;  // after the text
};

// A table that becomes a list of cards on a phone: every cell carries its column's name.
class HtmlTable {
 public:
  explicit HtmlTable(std::vector<std::string> columns, std::string_view css_class = {});
  void add(std::vector<HtmlCell> cells);
  [[nodiscard]] std::string html() const;

 private:
  std::vector<std::string> columns_;
  std::string css_class_, rows_;
};

}  // namespace app
