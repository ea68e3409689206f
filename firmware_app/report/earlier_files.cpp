#include "firmware_app/report/earlier_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "drivers/storage/text_file.h"

namespace app {
namespace {

bool is_named(const std::string& file, const std::vector<std::string_view>& names) {
  return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
    return name.ends_with('*') ? file.starts_with(name.substr(0, name.size() - 1)) : file == name;
  });
}

}  // namespace

void number_earlier(const std::filesystem::path& folder, std::string_view stem, const std::filesystem::path& made,
                    int keep) {
  namespace fs = std::filesystem;
  const auto numbered = [&](int i) { return folder / fmt::format("{}.{}", stem, i); };
  int free = 1;  // the first number without a folder: an interrupted shift left it
  while (free <= keep && fs::exists(fs::symlink_status(numbered(free)))) ++free;
  if (free > keep) fs::remove_all(numbered(keep));
  for (int i = std::min(free, keep); i > 1; --i) fs::rename(numbered(i - 1), numbered(i));
  if (keep > 0) {
    fs::rename(made, numbered(1));
  } else {
    fs::remove_all(made);
  }
}

void keep_earlier(const std::string& folder, std::string_view stem, const std::vector<std::string_view>& names) {
  namespace fs = std::filesystem;
  try {
    if (!fs::is_directory(folder)) return;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.is_regular_file() && is_named(entry.path().filename().string(), names)) files.push_back(entry.path());
    }
    const fs::path aside = fs::path(folder) / fmt::format("{}.replaced", stem);
    if (files.empty() && !fs::is_directory(aside)) return;
    fs::create_directory(aside);  // exists where an earlier call was interrupted
    for (const fs::path& file : files) fs::rename(file, aside / file.filename());
    number_earlier(folder, stem, aside, kEarlierResults);
  } catch (const fs::filesystem_error& error) {
    throw drivers::FileError(fmt::format(
        "{}: the earlier result in it cannot be kept: {}; name a folder that may be written", folder, error.what()));
  }
}

void keep_earlier_report(const std::string& folder) {
  keep_earlier(folder, "report", {"modal.json", "report.html", "displacements.svg", "spectra.svg", "modes.svg"});
}

}  // namespace app
