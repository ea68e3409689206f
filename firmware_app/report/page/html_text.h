#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace app {

// Pieces of an HTML page that is also well-formed XML except for its doctype. `text` parameters are escaped here;
// `html` parameters are markup of this program.

[[nodiscard]] std::string base64(std::string_view bytes);

[[nodiscard]] std::string section_html(std::string_view id, std::string_view title, const std::string& html);
[[nodiscard]] std::string paragraph_html(std::string_view text, std::string_view css_class = {});
// States why a section has no content.
[[nodiscard]] std::string absent_html(std::string_view text);
// The same for what only the set-ups of a merged result have, e.g. "spectrum".
[[nodiscard]] std::string merged_html(std::string_view what);

// A picture in two widths, of which the page's style shows one. `above` and `below`: html, e.g. a legend.
[[nodiscard]] std::string figure_html(const std::string& wide_svg, const std::string& narrow_svg,
                                      const std::string& above, const std::string& below);

struct HtmlCell {
  std::string text;
  std::string html;  // after the text
};

// A table that becomes a list of cards on a phone: every cell carries the name of its column.
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
