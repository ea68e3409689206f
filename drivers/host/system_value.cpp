#include "drivers/host/system_value.h"

#include <cmath>
#include <cstdlib>
#include <fstream>

namespace drivers {

namespace fs = std::filesystem;

std::string system_line(const fs::path& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  return line;
}

std::optional<double> system_number(const fs::path& path) {
  const std::string line = system_line(path);
  char* end = nullptr;
  const double value = std::strtod(line.c_str(), &end);
  if (end == line.c_str() || !std::isfinite(value)) return {};
  return value;
}

std::vector<fs::path> system_entries(const fs::path& folder, const std::string& prefix) {
  std::vector<fs::path> out;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().filename().string().starts_with(prefix)) out.push_back(it->path());
  }
  return out;
}

}  // namespace drivers
