#include "drivers/camera/recording/timestamp_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "drivers/storage/ascii.h"
#include "drivers/storage/csv_lines.h"
#include "drivers/storage/limits.h"

namespace drivers {

namespace fs = std::filesystem;

namespace {

constexpr double kMaxTime_s = 9.0e9;  // int64 nanoseconds end at 9.2e9 s; seconds since 1970 fit

// Part of a line for a message: short, and printable whatever the file contains.
std::string shown(std::string_view text) {
  std::string out(text.substr(0, 60));
  for (char& c : out) {
    if (c < ' ' || c > '~') c = '?';
  }
  return "'" + out + (text.size() > 60 ? "...'" : "'");
}

template <class T>
bool parse_whole(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), in_(path) {}

  std::vector<std::int64_t> read() {
    in_.require_lines(Limits::kTimestamps, "split the recording");
    std::string_view line;
    if (!next_line(line))
      throw std::runtime_error(fmt::format("{}: empty: write 'frame,t_s' and a line per frame", path_));
    const auto comma = line.find(',');
    if (comma == std::string_view::npos || trimmed(line.substr(0, comma)) != "frame" ||
        trimmed(line.substr(comma + 1)) != "t_s") {
      refuse(line, "the header must be 'frame,t_s'");
    }
    while (next_line(line)) read_stamp(line);
    if (stamps_ns_.empty()) {
      throw std::runtime_error(fmt::format("{}: no time stamp: write one line per frame, or remove the file", path_));
    }
    return std::move(stamps_ns_);
  }

 private:
  [[noreturn]] void refuse(std::string_view value, const std::string& remedy) const {
    throw std::runtime_error(fmt::format("{}:{}: {}: {}", path_, line_number_, shown(value), remedy));
  }

  bool next_line(std::string_view& line) {
    while (in_.next(line)) {
      ++line_number_;
      line = trimmed(line);
      if (!line.empty() && line.front() != '#') return true;
    }
    return false;
  }

  void read_stamp(std::string_view line) {
    const auto comma = line.find(',');
    if (comma == std::string_view::npos) refuse(line, "expected two fields, frame and t_s");
    std::uint64_t frame = 0;
    double t_s = 0.0;
    if (!parse_whole(trimmed(line.substr(0, comma)), frame) || frame != stamps_ns_.size()) {
      refuse(line,
             fmt::format("expected frame {}: one line per frame, counted from 0, none left out", stamps_ns_.size()));
    }
    if (!parse_whole(trimmed(line.substr(comma + 1)), t_s) || !std::isfinite(t_s) || std::fabs(t_s) > kMaxTime_s) {
      refuse(line, fmt::format("t_s must be a finite number of seconds, within +-{:g}", kMaxTime_s));
    }
    const std::int64_t t_ns = std::llround(t_s * 1e9);
    if (!stamps_ns_.empty() && t_ns <= stamps_ns_.back()) {
      refuse(line,
             fmt::format("time {} the one before ({:.9f} s): stamps must increase from frame to frame; remove the "
                         "file to use camera.rate_hz instead",
                         t_ns == stamps_ns_.back() ? "repeats" : "runs backward from",
                         static_cast<double>(stamps_ns_.back()) * 1e-9));
    }
    stamps_ns_.push_back(t_ns);
  }

  std::string path_;
  CsvLines in_;
  std::uint64_t line_number_ = 0;
  std::vector<std::int64_t> stamps_ns_;
};

}  // namespace

std::vector<std::int64_t> read_timestamp_file(const std::string& path) { return Reader(path).read(); }

std::string find_timestamp_file(const std::string& source) {
  const fs::path path = fs::absolute(source).lexically_normal();
  if (!fs::is_directory(path)) {
    const fs::path beside = fs::path(path).replace_extension(".timestamps.csv");
    return fs::exists(beside) ? beside.string() : std::string();
  }
  const fs::path folder = path.has_filename() ? path : path.parent_path();  // "folder/" has no file name
  const fs::path inside = folder / "timestamps.csv";
  const fs::path beside = fs::path(folder.string() + ".timestamps.csv");
  if (fs::exists(inside) && fs::exists(beside)) {
    throw std::runtime_error(
        fmt::format("{} and {}: two files of time stamps: remove one", inside.string(), beside.string()));
  }
  if (fs::exists(inside)) return inside.string();
  return fs::exists(beside) ? beside.string() : std::string();
}

double mean_rate_hz(const std::vector<std::int64_t>& stamps_ns) noexcept {
  const double span_s = static_cast<double>(stamps_ns.back() - stamps_ns.front()) * 1e-9;
  return static_cast<double>(stamps_ns.size() - 1) / span_s;
}

}  // namespace drivers
