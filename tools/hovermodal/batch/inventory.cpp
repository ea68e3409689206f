#include "tools/hovermodal/batch/inventory.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <regex>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <tuple>

namespace tools {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kClips{".mp4", ".mkv", ".avi", ".mov", ".m4v"};

// report.1, report.unfinished, ...: what earlier runs left beside a report, flights of another day.
bool is_earlier_report(const std::string& name) {
  static const std::regex form("report[.]([0-9]+|partial|unfinished|complete|placing|replaced)");
  return std::regex_match(name, form);
}

// Links to folders are listed and not followed: they may lead anywhere, and in circles.
std::vector<fs::path> files_below(const fs::path& folder, const fs::path& results, std::vector<fs::path>& links) {
  std::vector<fs::path> files;
  std::error_code error;
  const fs::path skipped = fs::weakly_canonical(results, error);
  const auto options = fs::directory_options::skip_permission_denied;
  for (auto at = fs::recursive_directory_iterator(folder, options); at != fs::recursive_directory_iterator(); ++at) {
    const bool is_folder = at->is_directory(error);
    if (is_folder && at->is_symlink(error)) {
      links.push_back(at->path());
      continue;
    }
    const bool is_result = is_folder && !results.empty() && fs::weakly_canonical(at->path(), error) == skipped;
    if (is_result || (is_folder && is_earlier_report(at->path().filename().string()))) at.disable_recursion_pending();
    if (at->is_regular_file(error)) files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class Finder {
 public:
  Finder(const fs::path& folder, const std::string& config) : folder_(folder), config_(config) {}

  // Call in ascending order, so that a record's first file comes before the others.
  void take(const fs::path& path) {
    const std::string name = path.filename().string();
    static const std::regex record("(.+_run[0-9]{4,8})_[0-9]{3,6}[.]lcm");
    std::smatch match;
    if (std::regex_match(name, match, record)) {
      const fs::path run = path.parent_path() / match[1].str();
      if (runs_.insert(run.string()).second) add(run, FlightKind::kRecord, path, "");
    } else if (name == "tracks.csv") {
      take_with_config(path.parent_path() == folder_ ? folder_ / "tracks" : path.parent_path(), FlightKind::kTracks,
                       path, {path.parent_path() / "config.yaml"});
    } else if (std::find(kClips.begin(), kClips.end(), path.extension().string()) != kClips.end()) {
      take_clip(path);
    }
  }

  void leave_out(const fs::path& path, const std::string& why) {
    found_.left_out.push_back(path.lexically_relative(folder_).generic_string() + ": " + why);
  }

  [[nodiscard]] Inventory finish() {
    auto& flights = found_.flights;
    std::sort(flights.begin(), flights.end(),
              [](const Flight& a, const Flight& b) { return std::tie(a.name, a.path) < std::tie(b.name, b.path); });
    std::set<std::string> names;
    for (Flight& flight : flights) {
      const std::string wanted = flight.name;
      for (int n = 2; !names.insert(flight.name).second; ++n) flight.name = fmt::format("{}_{}", wanted, n);
    }
    return std::move(found_);
  }

 private:
  void take_clip(const fs::path& path) {
    if (fs::exists(path.parent_path() / "tracks.csv")) {
      return leave_out(path, "there is a tracks.csv beside it, which is used instead");
    }
    fs::path own = path;
    own.replace_extension(".yaml");
    fs::path name = path;
    take_with_config(name.replace_extension(), FlightKind::kClip, path, {own, path.parent_path() / "config.yaml"});
  }

  void take_with_config(const fs::path& name, FlightKind kind, const fs::path& path,
                        const std::vector<fs::path>& places) {
    const auto found = std::find_if(places.begin(), places.end(), [](const fs::path& p) { return fs::exists(p); });
    if (found != places.end()) return add(name, kind, path, found->string());
    if (!config_.empty()) return add(name, kind, path, config_);
    std::string names;
    for (const fs::path& place : places) names += (names.empty() ? "" : " or ") + place.filename().string();
    leave_out(path, "no configuration: put " + names + " beside it, or give --config");
  }

  void add(const fs::path& name, FlightKind kind, const fs::path& path, const std::string& config) {
    found_.flights.push_back({name.lexically_relative(folder_).generic_string(), kind, path.string(), config});
  }

  fs::path folder_;
  std::string config_;
  std::set<std::string> runs_;
  Inventory found_;
};

}  // namespace

const char* to_string(FlightKind kind) noexcept {
  switch (kind) {
    case FlightKind::kRecord:
      return "record";
    case FlightKind::kTracks:
      return "tracks";
    case FlightKind::kClip:
      return "clip";
  }
  return "";
}

FlightKind flight_kind(const std::string& text) {
  for (const FlightKind kind : {FlightKind::kRecord, FlightKind::kTracks, FlightKind::kClip}) {
    if (text == to_string(kind)) return kind;
  }
  throw std::invalid_argument(text + ": no kind of flight");
}

Inventory find_flights(const std::string& folder, const std::string& results, const std::string& config) {
  if (!fs::is_directory(folder)) throw std::invalid_argument(folder + ": is no folder; name the one with the flights");
  Finder finder(folder, config);
  std::vector<fs::path> links;
  for (const fs::path& path : files_below(folder, results, links)) finder.take(path);
  std::sort(links.begin(), links.end());
  for (const fs::path& link : links)
    finder.leave_out(link, "a link to a folder is not followed: copy the flights, or name the folder that it leads to");
  return finder.finish();
}

}  // namespace tools
