#pragma once

#include <string>
#include <vector>

#include "firmware_app/replay/analysis.h"

namespace tools {

// The result for one file.
struct SeriesFindings {
  std::string name;
  std::vector<std::string> references;  // names of the channels that all set-ups share
  app::SeriesResult result;
};

// Modes, rejected poles, the response's peaks and the remarks, for a terminal.
[[nodiscard]] std::string findings_text(const app::SeriesResult& result);

// Writes modal.json beside the pictures of the analysis; returns the page to open.
std::string write_findings(const app::SeriesResult& result, const std::string& directory);

// The set-ups of one structure as one result; throws std::invalid_argument when they share no reference.
[[nodiscard]] app::SeriesResult merge_findings(const std::vector<SeriesFindings>& setups);

// modal.json and a page of the merged modes.
std::string write_merged(const app::SeriesResult& result, const app::PageHead& head, const std::string& directory);

}  // namespace tools
