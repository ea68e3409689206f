#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "tools/hovermodal/ground/web_server.h"

namespace tools {

// Converts the bytes of one complete request to the bytes of its answer.
class WebRoutes {
 public:
  struct Answer {
    std::string bytes;
    int status = 0;
    int event_source = -1;  // not below 0: `bytes` is the head of a stream of these events
  };
  enum class Kind { kAsset, kGet, kPost, kEvents };
  struct Route {
    Kind kind = Kind::kAsset;
    std::string content_type;    // assets
    std::string_view text;       // assets
    WebServer::Handler handler;  // GET, POST
    int event_source = -1;
  };

  WebRoutes(WebGuard guard, bool allow_post);
  ~WebRoutes();

  // Throws std::invalid_argument for an invalid path, or one that exists already.
  void add(const std::string& path, Route route);

  [[nodiscard]] Answer answer(std::string_view request) const;
  // Answer where no valid request arrived.
  [[nodiscard]] static Answer refusal(int status);

 private:
  struct Site;
  std::unique_ptr<Site> site_;
};

}  // namespace tools
