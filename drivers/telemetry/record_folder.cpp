#include "drivers/telemetry/record_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <regex>
#include <set>
#include <stdexcept>
#include <tuple>

#include "drivers/storage/partial_file.h"

namespace drivers {

namespace fs = std::filesystem;

namespace {

constexpr int kLastRun = 99'999'999;  // the names have at most eight digits

std::optional<RecordPart> parse_name(const fs::path& path) {
  static const std::regex form("[A-Za-z0-9_.-]+_run([0-9]{4,8})_([0-9]{3,6})[.]lcm");
  const std::string name = path.filename().string();
  std::smatch match;
  if (!std::regex_match(name, match, form)) return std::nullopt;
  return RecordPart{path.string(), std::stoi(match[1]), std::stoi(match[2]), 0};
}

}  // namespace

std::string record_name(std::string_view stream_id, int run, int file) {
  return fmt::format("{}_run{:04}_{:03}.lcm", stream_id, run, file);
}

void remove_partial_records(const std::string& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::error_code refused;
    if (entry.path().extension() == kPartialExtension && parse_name(entry.path().stem()))
      fs::remove(entry.path(), refused);
  }
}

int next_run(const std::vector<RecordPart>& parts) {
  std::set<int> used{0};
  for (const RecordPart& part : parts) used.insert(part.run);
  for (auto run = used.rbegin(); run != used.rend(); ++run) {
    if (*run < kLastRun && !used.contains(*run + 1)) return *run + 1;
  }
  throw std::runtime_error("no number is left for another run; move the records to another folder");
}

std::vector<RecordPart> record_parts(const std::string& folder) {
  std::vector<RecordPart> parts;
  for (const auto& entry : fs::directory_iterator(folder)) {
    auto part = parse_name(entry.path());
    std::error_code gone;
    if (!part || !entry.is_regular_file(gone)) continue;
    part->n_bytes = entry.file_size(gone);
    if (!gone) parts.push_back(std::move(*part));
  }
  std::sort(parts.begin(), parts.end(), [](const RecordPart& a, const RecordPart& b) {
    return std::tie(a.run, a.file, a.path) < std::tie(b.run, b.file, b.path);
  });
  return parts;
}

bool make_room(const std::string& folder, int run, std::uint64_t wanted_bytes, std::uint64_t quota_bytes) {
  const std::vector<RecordPart> parts = record_parts(folder);
  std::uint64_t total = wanted_bytes;
  for (const RecordPart& part : parts) total += part.n_bytes;
  for (const RecordPart& part : parts) {
    if (total <= quota_bytes) return true;
    std::error_code refused;
    if (part.run < run && fs::remove(part.path, refused)) total -= part.n_bytes;
  }
  return total <= quota_bytes;
}

std::vector<std::string> files_from(const std::string& path) {
  std::vector<std::string> files{path};
  const auto first = parse_name(path);
  if (!first) return files;
  const fs::path at(path);
  const std::string name = at.filename().string();
  const std::string stem = name.substr(0, name.rfind("_run"));
  for (int file = first->file + 1;; ++file) {
    const fs::path next = at.parent_path() / record_name(stem, first->run, file);
    if (!fs::is_regular_file(next)) return files;
    files.push_back(next.string());
  }
}

}  // namespace drivers
