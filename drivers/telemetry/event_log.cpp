#include "drivers/telemetry/event_log.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace drivers {

EventLogFile::EventLogFile(const std::string& path)
    : log_(lcm_eventlog_create(path.c_str(), "w"), &lcm_eventlog_destroy) {
  if (!log_)
    throw std::runtime_error(fmt::format(
        "LCM event log \"{}\": cannot be written: {}. Check telemetry.log_file or record.directory, the folder and its "
        "permissions.",
        path, std::strerror(errno)));
}

bool EventLogFile::write(const std::string& channel, std::span<const std::uint8_t> bytes,
                         std::int64_t utc_ns) noexcept {
  constexpr std::uint64_t kHeadBytes = 28;  // sync word, number, time, two lengths
  lcm_eventlog_event_t event{};
  event.timestamp = utc_ns / 1000;
  event.channellen = static_cast<std::int32_t>(channel.size());
  event.datalen = static_cast<std::int32_t>(bytes.size());
  event.channel = const_cast<char*>(channel.data());  // read only
  event.data = const_cast<std::uint8_t*>(bytes.data());
  n_bytes_ += kHeadBytes + channel.size() + bytes.size();
  return lcm_eventlog_write_event(log_.get(), &event) == 0 && std::ferror(log_->f) == 0;
}

bool EventLogFile::flush() noexcept { return std::fflush(log_->f) == 0; }

}  // namespace drivers
