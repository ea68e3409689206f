#include "drivers/telemetry/event_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "drivers/storage/partial_file.h"
#include "drivers/storage/regular_file.h"
#include "drivers/telemetry/event_log_format.h"

namespace drivers {
namespace {

constexpr std::size_t kEventBlockBytes = 1U << 16U;

void append_big_endian(std::vector<std::uint8_t>& out, std::uint64_t value, int n_bytes) {
  for (int shift = 8 * (n_bytes - 1); shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

}  // namespace

EventLogFile::EventLogFile(const std::string& path, Link link)
    : descriptor_(::open(path.c_str(),
                         O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | (link == Link::kRefuse ? O_NOFOLLOW : 0), 0644)) {
  if (descriptor_ < 0) {
    throw std::runtime_error(fmt::format(
        "LCM event log \"{}\": cannot be written: {}. Check telemetry.log_file or record.directory, the folder and its "
        "permissions.",
        path, std::generic_category().message(errno)));
  }
}

EventLogFile::~EventLogFile() { (void)close(); }

// Sync word, number, time in us, two lengths, channel, data: big endian.
void EventLogFile::append(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utc_ns) {
  append_big_endian(block_, kEventSync, 4);
  append_big_endian(block_, static_cast<std::uint64_t>(n_events_++), 8);
  append_big_endian(block_, static_cast<std::uint64_t>(utc_ns / 1000), 8);
  append_big_endian(block_, channel.size(), 4);
  append_big_endian(block_, bytes.size(), 4);
  block_.insert(block_.end(), channel.begin(), channel.end());
  block_.insert(block_.end(), bytes.begin(), bytes.end());
  ends_.push_back(block_.size());
}

bool EventLogFile::write(const std::string& channel, std::span<const std::uint8_t> bytes,
                         std::int64_t utc_ns) noexcept {
  const std::size_t n_before = block_.size();
  try {
    append(channel, bytes, utc_ns);
  } catch (const std::exception&) {  // out of memory
    block_.resize(n_before);
    error_ = ENOMEM;
    ++n_lost_;
    return false;
  }
  n_bytes_ = n_kept_ + block_.size();
  return block_.size() < kEventBlockBytes || flush();
}

bool EventLogFile::flush() noexcept {
  const bool is_open = descriptor_ >= 0;
  const std::size_t n_written = is_open ? write_bytes(descriptor_, block_.data(), block_.size()) : 0;
  const bool is_whole = is_open && n_written == block_.size();
  if (is_whole) {
    n_kept_ += n_written;
  } else {
    if (is_open) error_ = errno;
    keep_whole_events(n_written);
  }
  block_.clear();
  ends_.clear();
  n_bytes_ = n_kept_;
  return is_whole;
}

// The written part of an event would hide the event after it.
void EventLogFile::keep_whole_events(std::size_t n_written) noexcept {
  const auto first_lost = std::upper_bound(ends_.begin(), ends_.end(), n_written);
  const std::size_t n_whole = first_lost == ends_.begin() ? 0 : *(first_lost - 1);
  n_lost_ += static_cast<std::uint64_t>(ends_.end() - first_lost);
  const auto end = static_cast<off_t>(n_kept_ + n_whole);
  const bool is_cut =
      n_written == n_whole || (::ftruncate(descriptor_, end) == 0 && ::lseek(descriptor_, end, SEEK_SET) == end);
  n_kept_ += is_cut ? n_whole : n_written;
}

bool EventLogFile::sync() noexcept {
  const bool is_flushed = flush();
  if (descriptor_ < 0) return false;
  if (sync_to_disk(descriptor_)) return is_flushed;
  error_ = errno;
  return false;
}

bool EventLogFile::close() noexcept {
  if (descriptor_ < 0) return error_ == 0;
  (void)sync();
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) error_ = errno;
  return error_ == 0;
}

}  // namespace drivers
