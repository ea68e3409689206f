#include <string>

#include "tools/hovermodal/ground/page.h"
#include "tools/hovermodal/ground/web_server.h"

namespace tools {
namespace {

std::string content_type(std::string_view name) {
  const std::string_view ending = name.substr(name.rfind('.') + 1);
  if (ending == "html") return "text/html; charset=utf-8";
  if (ending == "css") return "text/css; charset=utf-8";
  if (ending == "js") return "text/javascript; charset=utf-8";
  if (ending == "svg") return "image/svg+xml";
  return "application/octet-stream";
}

}  // namespace

void add_page(WebServer& server, std::span<const PageFile> files) {
  for (const PageFile& file : files) {
    const std::string path = file.name == "index.html" ? "/" : "/" + std::string(file.name);
    server.add_asset(path, content_type(file.name), file.text);
  }
}

}  // namespace tools
