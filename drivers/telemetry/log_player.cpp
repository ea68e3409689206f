#include "drivers/telemetry/log_player.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "rt/clock.h"

namespace drivers {
namespace {

constexpr std::string_view kScheme = "file://";
constexpr int kMaxPlayed = 1000;  // limits the time during which display and signals wait
constexpr double kLongestWait_ns = 1e9;

[[noreturn]] void refuse_log(const std::string& url, const std::string& what) {
  throw std::invalid_argument(
      fmt::format("LCM URL \"{}\": {}. Expected file://PATH?speed=S, for example file://run.lcm?speed=0 (as fast as "
                  "possible)",
                  url, what));
}

template <class Number>
bool parse(std::string_view text, Number& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size();
}

void set_option(const std::string& url, std::string_view option, LogUrl& out) {
  const std::size_t equals = std::min(option.find('='), option.size());
  const std::string_view key = option.substr(0, equals), value = option.substr(std::min(equals + 1, option.size()));
  if (key == "speed") {
    if (!parse(value, out.speed) || !std::isfinite(out.speed) || out.speed < 0.0)
      refuse_log(url, fmt::format("speed \"{}\" is not a number from 0 on", value));
  } else if (key == "start_timestamp") {
    if (!parse(value, out.start_utc_us))
      refuse_log(url, fmt::format("start_timestamp \"{}\" is not a number of microseconds", value));
  } else if (key != "mode" || value != "r") {
    refuse_log(url, fmt::format("\"{}\" is no option of a log that is read (known: speed, start_timestamp)", option));
  }
}

}  // namespace

bool is_log(const std::string& url) { return std::string_view(url).substr(0, kScheme.size()) == kScheme; }

LogUrl parse_log(const std::string& url) {
  if (!is_log(url)) refuse_log(url, "does not begin with file://");
  const std::string_view rest = std::string_view(url).substr(kScheme.size());
  const std::size_t question = std::min(rest.find('?'), rest.size());
  LogUrl out;
  out.path = std::string(rest.substr(0, question));
  if (out.path.empty()) refuse_log(url, "the path is missing");
  std::string_view options = rest.substr(std::min(question + 1, rest.size()));
  while (!options.empty()) {
    const std::size_t end = std::min(options.find('&'), options.size());
    set_option(url, options.substr(0, end), out);
    options.remove_prefix(std::min(end + 1, options.size()));
  }
  return out;
}

LogPlayer::LogPlayer(const LogUrl& url, LcmDatagrams::Receive receive)
    : url_(url), receive_(std::move(receive)), log_(url.path) {}

// In double, because stamps from a file may have any value.
std::int64_t LogPlayer::wait_ns() const {
  if (url_.speed <= 0.0) return 0;
  const double due_ns = (static_cast<double>(event_.utc_us) - static_cast<double>(first_utc_us_)) * 1e3 / url_.speed;
  return static_cast<std::int64_t>(
      std::clamp(due_ns - static_cast<double>(rt::monotonic_ns() - began_ns_), 0.0, kLongestWait_ns));
}

bool LogPlayer::poll(int timeout_ms) {
  const std::int64_t end_ns = rt::monotonic_ns() + std::int64_t{timeout_ms} * 1'000'000;
  for (int n = 0; n < kMaxPlayed; ++n) {
    while (!has_event_) {
      if (!log_.next(event_)) return false;
      has_event_ = event_.utc_us >= url_.start_utc_us;
    }
    if (!has_begun_) has_begun_ = true, first_utc_us_ = event_.utc_us, began_ns_ = rt::monotonic_ns();
    if (const std::int64_t wait = wait_ns(); wait > 0) {
      const std::int64_t left = n == 0 ? std::max<std::int64_t>(0, end_ns - rt::monotonic_ns()) : 0;
      std::this_thread::sleep_for(std::chrono::nanoseconds(std::min(wait, left)));
      if (wait_ns() > 0) return true;
    }
    has_event_ = false;
    receive_(event_.channel, event_.data.data(), event_.data.size());
  }
  return true;
}

}  // namespace drivers
