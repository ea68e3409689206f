#pragma once

#include <string>

#include "tools/hovermodal/answer.h"

namespace tools {

enum class SpyView { kModes, kStages };

struct SpyOptions {
  SpyView view = SpyView::kModes;
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string prefix = "HOVERMODAL";
  bool once = false;
  double seconds = 0.0;  // 0 = no limit
  bool plain = false;
  std::string count_file;  // empty = none
  Answer answer;           // --json: the numbers of messages at the end, in place of what is shown
};

// Listens and shows until stopped (SIGINT, SIGTERM, --once, --seconds, end of a log). Throws
// std::invalid_argument for a wrong URL or prefix, std::runtime_error if nothing can be received on the URL, if the
// count file cannot be written, or if --once saw no end within --seconds.
void run_spy(const SpyOptions& options);

}  // namespace tools
