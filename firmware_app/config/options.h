#pragma once

#include <optional>
#include <string>
#include <vector>

namespace app {

// The command line of hovermodald.
struct Options {
  std::string config_path;
  std::vector<std::string> overrides;  // section.key=value; --report becomes report.directory=DIR
  bool check_only = false;
  std::optional<int> exit_code;  // set: the parser has already handled the call (help, version, usage error)
};

[[nodiscard]] Options parse_options(int argc, char** argv);

}  // namespace app
