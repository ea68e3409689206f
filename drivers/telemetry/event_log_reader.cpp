#include "drivers/telemetry/event_log_reader.h"

#include <algorithm>
#include <array>

#include "drivers/storage/limits.h"
#include "drivers/telemetry/event_log_format.h"

namespace drivers {
namespace {

constexpr std::size_t kSyncBytes = 4, kHeadBytes = 24;
constexpr std::size_t kReadAtOnce = 1U << 16U;

std::uint64_t big_endian(const std::uint8_t* bytes, std::size_t n) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < n; ++i) value = value << 8U | bytes[i];
  return value;
}

}  // namespace

EventLogReader::EventLogReader(const std::string& path)
    : path_(path), file_(open_regular_file(path, "name an LCM event log")) {}

bool EventLogReader::next(Event& out) {
  for (;;) {
    switch (take(out)) {
      case Taken::kEvent:
        return true;
      case Taken::kEnd:
        return false;
      case Taken::kDamaged:
        ++n_damaged_;
        break;
    }
  }
}

bool EventLogReader::read(void* to, std::size_t n_bytes) {
  return read_bytes(file_.get(), to, n_bytes, path_) == n_bytes;
}

std::optional<std::uint8_t> EventLogReader::next_byte() {
  const int byte = ::getc_unlocked(file_.get());  // of one thread; a damaged record may be gigabytes of it
  if (byte != EOF) return static_cast<std::uint8_t>(byte);
  if (std::ferror(file_.get()) == 0) return std::nullopt;
  std::clearerr(file_.get());
  std::uint8_t again = 0;  // repeats an interrupted read, and names a fault of the disk
  return read(&again, 1) ? std::optional(again) : std::nullopt;
}

bool EventLogReader::find_event() {
  std::uint32_t seen = 0;
  while (seen != kEventSync) {
    const std::optional<std::uint8_t> byte = next_byte();
    if (!byte) return false;
    seen = seen << 8U | *byte;
  }
  return true;
}

EventLogReader::Taken EventLogReader::take(Event& out) {
  std::array<std::uint8_t, kHeadBytes> head{};  // number, time, two lengths
  if (!find_event() || !read(head.data(), head.size())) return Taken::kEnd;
  out.utc_us = static_cast<std::int64_t>(big_endian(head.data() + 8, 8));
  const auto n_channel = static_cast<std::int32_t>(big_endian(head.data() + 16, 4));
  const auto n_data = static_cast<std::int32_t>(big_endian(head.data() + 20, 4));
  if (n_channel < 1 || n_channel > kLongestChannel || n_data < 0 ||
      static_cast<std::uint64_t>(n_data) > Limits::kRecordEventBytes)
    return Taken::kDamaged;
  out.channel.resize(static_cast<std::size_t>(n_channel));
  if (!read(out.channel.data(), out.channel.size())) return Taken::kEnd;
  out.data.clear();
  for (auto n_left = static_cast<std::size_t>(n_data); n_left > 0;) {
    const std::size_t n = std::min(n_left, kReadAtOnce), at = out.data.size();
    out.data.resize(at + n);
    if (!read(out.data.data() + at, n)) return Taken::kEnd;
    n_left -= n;
  }
  // The following bytes must be an event; otherwise the length was wrong.
  std::array<std::uint8_t, kSyncBytes> behind{};
  const std::size_t n_behind = read_bytes(file_.get(), behind.data(), behind.size(), path_);
  if (n_behind < behind.size()) return Taken::kEvent;
  std::fseek(file_.get(), -static_cast<long>(kSyncBytes), SEEK_CUR);
  return big_endian(behind.data(), behind.size()) == kEventSync ? Taken::kEvent : Taken::kDamaged;
}

}  // namespace drivers
