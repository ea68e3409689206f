#pragma once

#include <string>
#include <vector>

namespace tools {

struct GroundOptions {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string prefix = "HOVERMODAL";
  std::string bind_address = "127.0.0.1";
  int port = 8086;
  std::string token;               // empty: none on a loopback address, a random one elsewhere
  std::vector<std::string> names;  // other names by which the page is opened
  double seconds = 0.0;            // 0 = until told to stop
};

// Serves the page until told to stop (SIGINT, SIGTERM, seconds). Throws std::invalid_argument for options that cannot
// be, std::runtime_error when nothing can be heard or the address cannot be used.
void run_ground(const GroundOptions& options);

}  // namespace tools
