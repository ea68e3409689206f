#include "firmware_app/report/structure_section.h"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>

#include "drivers/storage/json.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/closure_modes_svg.h"
#include "firmware_app/report/page/html_text.h"
#include "firmware_app/report/plot/svg_document.h"

namespace app {
namespace {

constexpr const char* kSection = "<section id=\"structure\">";
constexpr const char* kSectionEnd = "</section>\n";
constexpr const char* kBefore = "<section id=\"losses\">";
constexpr const char* kLink = "<a href=\"#structure\">Structure</a>\n";
constexpr const char* kLinkBefore = "<a href=\"#losses\">";

// As wide as the page; on a narrow screen it scrolls, because it has one form only.
std::string scrolled_picture(const core::closure::LoopLevel::Picture& picture) {
  return paragraph_html(picture.title + ".") +
         fmt::format("<div class=\"plot scrolled\" tabindex=\"0\" role=\"group\" aria-label=\"{}\">{}</div>\n",
                     svg_escaped(picture.title), picture.svg);
}

}  // namespace

std::string modes_figure_html(const core::closure::ClosureResult& drawn, const std::string& axis) {
  const std::string wide = closure_modes_svg(drawn, axis);
  return wide.empty() ? wide : figure_html(wide, closure_modes_narrow_svg(drawn, axis), {}, {});
}

std::string structure_section(const core::closure::LoopResult& result) {
  std::string out;
  for (const core::closure::LoopLevel& level : result.levels) {
    if (level.level != "structure" || !level.result) continue;
    out += modes_figure_html(*level.result, kModelErrorAxis);
    for (const core::closure::LoopLevel::Picture& one : level.pictures) out += scrolled_picture(one);
  }
  return out.empty() ? out : section_html("structure", "The declared structure and the modes", out);
}

std::string with_structure_section(const std::string& page, const std::string& section) {
  if (section.empty()) return page;
  std::string out = page;
  if (const auto earlier = out.find(kSection); earlier != std::string::npos) {
    const auto end = out.find(kSectionEnd, earlier);
    if (end == std::string::npos) return page;
    return out.replace(earlier, end + std::string(kSectionEnd).size() - earlier, section);
  }
  const auto at = out.find(kBefore), link = out.find(kLinkBefore);
  if (at == std::string::npos || link == std::string::npos || link > at) return page;
  out.insert(at, section);
  return out.insert(link, kLink);
}

void add_structure_to_report(const std::string& directory, const core::closure::LoopResult& result) {
  const std::filesystem::path path = std::filesystem::path(directory) / "report.html";
  const std::string section = structure_section(result);
  if (section.empty() || !std::filesystem::exists(path)) return;
  const std::string page = drivers::read_text_file(path.string(), drivers::Limits::kPageBytes);
  drivers::write_file_atomically(path.string(), with_structure_section(page, section));
}

}  // namespace app
