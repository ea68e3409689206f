#include "tools/hovermodal/ground/live_stream.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace tools {
namespace {

using drivers::StreamMonitor;

// Applies to all topics: the first channel with a message of the new run counts the restart; the others follow it.
constexpr double kOneRestart_ns = 5e9;
constexpr std::size_t kMostJpegBytes = 300'000;  // far above a preview of this service

std::uint64_t foreign(const StreamMonitor& monitor) {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < StreamMonitor::kTopics; ++i)
    n += monitor.count(static_cast<StreamMonitor::Topic>(i)).foreign;
  return n;
}

// Displacements and health come continuously, and show a restart first.
std::uint64_t restarts(const StreamMonitor& monitor) {
  return monitor.count(StreamMonitor::kHealth).restarts + monitor.count(StreamMonitor::kDisplacement).restarts;
}

std::int64_t newest_utc_ns(const StreamMonitor& monitor) {
  return std::max(monitor.count(StreamMonitor::kHealth).last_utc_ns,
                  monitor.count(StreamMonitor::kDisplacement).last_utc_ns);
}

}  // namespace

LiveStream::LiveStream(std::string prefix)
    : prefix_(std::move(prefix)),
      monitor_(std::make_unique<StreamMonitor>(prefix_)),
      boot_(std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::system_clock::now().time_since_epoch())
                .count()) {}

void LiveStream::receive(std::string_view lcm_channel, const void* data, std::size_t n_bytes,
                         std::int64_t now_ns) noexcept {
  const std::lock_guard lock(mutex_);
  monitor_->receive(lcm_channel, data, n_bytes, now_ns);
  try {
    const std::uint64_t n_foreign = foreign(*monitor_);
    if (n_foreign != n_foreign_ && now_ns - monitor_->last_received_ns() > kSilence_ns) {
      monitor_ = std::make_unique<StreamMonitor>(prefix_);
      monitor_->receive(lcm_channel, data, n_bytes, now_ns);
      n_restarts_ = n_foreign_ = 0, run_since_utc_ns_ = 0;
      ++run_;
      return;
    }
    n_foreign_ = n_foreign;
  } catch (...) {  // out of memory: the old stream is kept
  }
  const std::uint64_t n_restarts = restarts(*monitor_);
  if (n_restarts == n_restarts_) return;
  n_restarts_ = n_restarts;
  const std::int64_t utc_ns = newest_utc_ns(*monitor_);
  if (static_cast<double>(utc_ns) - static_cast<double>(run_since_utc_ns_) < kOneRestart_ns) return;
  run_since_utc_ns_ = utc_ns;
  ++run_;
}

LiveView LiveStream::view(std::int64_t now_ns) const { return {*monitor_, run_, run_since_utc_ns_, boot_, now_ns}; }

std::string LiveStream::snapshot(std::int64_t now_ns) const {
  const std::lock_guard lock(mutex_);
  Shown nothing;
  return snapshot_json(view(now_ns), nothing);
}

std::optional<std::string> LiveStream::news(std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  if (!has_news(view(now_ns), shown_) && now_ns - told_ns_ < kLinkPeriod_ns) return std::nullopt;
  told_ns_ = now_ns;
  return snapshot_json(view(now_ns), shown_);
}

std::string LiveStream::preview_jpeg() const {
  const std::lock_guard lock(mutex_);
  const auto& preview = monitor_->preview();
  if (!preview || preview->jpeg.size() < 2 || preview->jpeg.size() > kMostJpegBytes) return {};
  if (preview->jpeg[0] != 0xFF || preview->jpeg[1] != 0xD8) return {};  // not a JPEG
  return {preview->jpeg.begin(), preview->jpeg.end()};
}

}  // namespace tools
