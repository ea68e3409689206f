#include "drivers/camera/recording/srt_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "drivers/storage/ascii.h"
#include "drivers/storage/csv_lines.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/regular_file.h"
#include "drivers/storage/text_file.h"

namespace drivers {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostBlocks = Limits::kSubtitleBlocks;

// Before the text is read: every block has a line with an arrow.
void require_few_blocks(const std::string& path) {
  if (bytes_of(open_regular_file(path, "name an .SRT file", Limits::kSubtitleBytes).get()) <= kMostBlocks) return;
  CsvLines lines(path);
  std::string_view line;
  for (std::size_t n = 0; lines.next(line);) {
    if (line.find("-->") != std::string_view::npos && ++n > kMostBlocks)
      lines.fail(fmt::format("more than {} blocks", kMostBlocks));
  }
}

bool is_word(char c) noexcept { return is_letter(c) || c == '_'; }

// The number at the beginning of `text`, which is removed from it.
std::optional<double> take_number(std::string_view& text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || !std::isfinite(value)) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

void skip(std::string_view& text, std::string_view any_of) {
  text.remove_prefix(std::min(text.find_first_not_of(any_of), text.size()));
}

// The text after the word `key` and its colon; empty: no such word. A key is delimited by characters other than
// letters and digits.
std::optional<std::string_view> after_key(std::string_view text, std::string_view key) {
  for (std::size_t at = text.find(key); at != std::string_view::npos; at = text.find(key, at + 1)) {
    const std::size_t end = at + key.size();
    if (at > 0 && (is_word(text[at - 1]) || is_digit(text[at - 1]) || text[at - 1] == '.')) continue;
    if (end < text.size() && is_word(text[end])) continue;
    std::string_view rest = text.substr(end);
    skip(rest, " :=(");
    return rest;
  }
  return {};
}

std::optional<double> number_after(std::string_view text, std::string_view key) {
  std::optional<std::string_view> rest = after_key(text, key);
  return rest ? take_number(*rest) : std::nullopt;
}

std::optional<double> plausible_exposure(double exposure_s) {
  constexpr double kLeast_s = 1e-7, kMost_s = 100.0;
  return exposure_s >= kLeast_s && exposure_s <= kMost_s ? std::optional(exposure_s) : std::nullopt;
}

// "1/80.0" is in seconds; "80" or "30.15" is the inverse.
std::optional<double> exposure_in(std::string_view text) {
  for (const char* key : {"shutter", "Shutter", "TV", "SS"}) {
    std::optional<std::string_view> rest = after_key(text, key);
    if (!rest) continue;
    const std::optional<double> first = take_number(*rest);
    if (!first || !(*first > 0.0)) continue;
    if (rest->empty() || rest->front() != '/') return plausible_exposure(1.0 / *first);
    rest->remove_prefix(1);
    const std::optional<double> second = take_number(*rest);
    if (second && *second > 0.0) return plausible_exposure(*first / *second);
  }
  return {};
}

std::optional<std::array<double, 3>> gimbal_in(std::string_view text) {
  const auto roll = number_after(text, "gb_roll"), pitch = number_after(text, "gb_pitch"),
             yaw = number_after(text, "gb_yaw");
  if (roll && pitch && yaw) return std::array{*roll, *pitch, *yaw};
  std::optional<std::string_view> rest = after_key(text, "G.PRY");
  if (!rest) return {};
  std::array<double, 3> pry{};
  for (double& angle : pry) {
    skip(*rest, " ,\xC2\xB0");  // and the degree sign
    const std::optional<double> value = take_number(*rest);
    if (!value) return {};
    angle = *value;
  }
  return std::array{pry[1], pry[0], pry[2]};
}

// "00:00:01,033 --> ..."
std::optional<double> cue_in(std::string_view text) {
  if (text.find("-->") == std::string_view::npos) return {};
  double seconds = 0.0;
  for (const double unit_s : {3600.0, 60.0, 1.0, 1e-3}) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return {};
    seconds += unit_s * value;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty()) text.remove_prefix(1);
  }
  return seconds;
}

struct Clock {
  double t_s = 0.0, tick_s = 1.0;
};

// "2021-12-25 12:27:52.373", "2022-08-07 13:40:40,774,808", "2017.8.5 14:11:51" anywhere in the line.
std::optional<Clock> clock_in(std::string_view line) {
  for (std::size_t at = 0; at + 14 < line.size(); ++at) {
    if (!is_digit(line[at]) || (at > 0 && is_digit(line[at - 1]))) continue;
    std::string_view text = line.substr(at);
    std::array<int, 6> part{};
    std::size_t n = 0;
    for (; n < part.size(); ++n) {
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), part[n]);
      if (error != std::errc() || end - text.data() > 4) break;
      text.remove_prefix(static_cast<std::size_t>(end - text.data()));
      if (n + 1 == part.size()) continue;
      const std::string_view between = n < 2 ? std::string_view("-./") : n == 2 ? std::string_view(" T") : ":";
      if (text.empty() || between.find(text.front()) == std::string_view::npos) break;
      text.remove_prefix(1);
    }
    const std::chrono::year_month_day day{std::chrono::year(part[0]),
                                          std::chrono::month(static_cast<unsigned>(part[1])),
                                          std::chrono::day(static_cast<unsigned>(part[2]))};
    if (n < part.size() || !day.ok() || part[0] < 1990 || part[3] > 24 || part[4] > 59 || part[5] > 60) continue;
    const auto days = std::chrono::sys_days(day).time_since_epoch().count();
    Clock clock{static_cast<double>(days) * 86400.0 + part[3] * 3600.0 + part[4] * 60.0 + part[5], 1.0};
    for (const double unit_s : {1e-3, 1e-6}) {  // milliseconds, microseconds: three digits each
      if (text.size() < 4 || (text.front() != ',' && text.front() != '.')) break;
      if (!is_digit(text[1]) || !is_digit(text[2]) || !is_digit(text[3])) break;
      clock.t_s += unit_s * ((text[1] - '0') * 100 + (text[2] - '0') * 10 + (text[3] - '0'));
      clock.tick_s = unit_s;
      text.remove_prefix(4);
    }
    return clock;
  }
  return {};
}

class Parser {
 public:
  explicit Parser(const std::string& name) : name_(name) {}

  SrtFile parse(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      take(trimmed(text.substr(0, end)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    close_block();
    if (out_.blocks.empty()) {
      throw std::runtime_error(
          fmt::format("{}:{}: no block of telemetry: empty, cut off, or not the subtitles of a "
                      "camera",
                      name_, std::max<std::size_t>(line_, 1)));
    }
    return std::move(out_);
  }

 private:
  void take(std::string_view line) {
    if (line.empty()) return;
    if (line.size() < 10 && std::all_of(line.begin(), line.end(), is_digit)) {
      close_block();
      is_open_ = true, block_ = {}, block_line_ = line_, knows_anything_ = false;
      return;
    }
    if (!is_open_) return;
    if (const auto cue = cue_in(line)) {
      block_.cue_s = cue;
      return;
    }
    if (const auto clock = clock_in(line); clock && !block_.clock_s) {
      block_.clock_s = clock->t_s;
      if (clock->tick_s < out_.clock_tick_s) out_.clock_tick_s = clock->tick_s;
      knows_anything_ = true;
    }
    for (const char* key : {"FrameCnt", "SrtCnt"}) {
      const auto number = number_after(line, key);
      if (number && *number >= 0.0 && *number < 1e15) set(block_.frame, static_cast<std::uint64_t>(*number));
    }
    if (const auto exposure = exposure_in(line)) set(block_.exposure_s, *exposure);
    if (const auto focal = number_after(line, "focal_len"); focal && *focal > 0.0) set(block_.focal_length, *focal);
    if (const auto ratio = number_after(line, "dzoom_ratio"); ratio && *ratio > 0.0)
      set(block_.zoom, *ratio >= 1000.0 ? *ratio / 10000.0 : *ratio);
    if (const auto gimbal = gimbal_in(line)) set(block_.gimbal_deg, *gimbal);
    if (line.find("GPS") != std::string_view::npos || line.find("iso") != std::string_view::npos ||
        line.find("ISO") != std::string_view::npos)
      knows_anything_ = true;
  }

  template <class T>
  void set(std::optional<T>& value, const T& found) {
    if (!value) value = found;
    knows_anything_ = true;
  }

  // A block cut off within a line keeps the values read; a block without any known value is not telemetry.
  void close_block() {
    if (!is_open_) return;
    is_open_ = false;
    if (!knows_anything_) {
      n_empty_ += 1;
      constexpr std::size_t kMostEmpty = 16;
      if (n_empty_ > kMostEmpty && out_.blocks.size() < n_empty_) {
        throw std::runtime_error(
            fmt::format("{}:{}: ordinary subtitles: no time, exposure or attitude in them", name_, block_line_));
      }
      return;
    }
    if (out_.blocks.size() == kMostBlocks)
      throw std::runtime_error(fmt::format("{}:{}: more than {} blocks", name_, block_line_, kMostBlocks));
    out_.blocks.push_back(block_);
  }

  std::string name_;
  SrtFile out_;
  SrtBlock block_;
  bool is_open_ = false, knows_anything_ = false;
  std::size_t line_ = 0, block_line_ = 0, n_empty_ = 0;
};

}  // namespace

SrtFile parse_srt(std::string_view text, const std::string& name) { return Parser(name).parse(text); }

SrtFile read_srt(const std::string& path) {
  require_few_blocks(path);
  return parse_srt(read_text_file(path, Limits::kSubtitleBytes), path);
}

std::string find_srt(const std::string& video) {
  const fs::path path = fs::absolute(video).lexically_normal();
  if (fs::is_directory(path)) return {};
  for (const char* extension : {".SRT", ".srt", ".Srt"}) {
    const fs::path beside = fs::path(path).replace_extension(extension);
    if (beside != path && fs::is_regular_file(beside)) return beside.string();
  }
  return {};
}

}  // namespace drivers
