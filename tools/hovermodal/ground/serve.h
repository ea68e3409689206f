#pragma once

#include <string>
#include <vector>

#include "tools/hovermodal/answer.h"

namespace tools {

struct GroundOptions {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string prefix = "HOVERMODAL";
  std::string bind_address = "127.0.0.1";
  int port = 8086;
  std::string token;               // empty: none on a loopback address, a random one elsewhere
  std::vector<std::string> names;  // other host names under which the page is opened
  double seconds = 0.0;            // 0 = until stopped
  Answer answer;
};

// Serves the page until stopped (SIGINT, SIGTERM, seconds). Throws std::invalid_argument for impossible options,
// std::runtime_error if nothing can be received or the address cannot be used.
void run_ground(const GroundOptions& options);

}  // namespace tools
