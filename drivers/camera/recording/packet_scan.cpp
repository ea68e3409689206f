#include "drivers/camera/recording/packet_scan.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

#include "drivers/camera/recording/container.h"

namespace drivers {

namespace {

constexpr std::size_t kMostScanned = std::size_t{1} << 22;
constexpr std::uint64_t kMostScannedBytes = std::uint64_t{1} << 30;
constexpr double kWithTimes = 0.99;  // if fewer packets than this share have a time, the format carries none
constexpr double kBackward_s = 1.0;
constexpr std::int64_t kMostTicks = std::int64_t{1} << 60;  // larger values: a difference could overflow
constexpr double kMostSpan_s = 1e9;

// VP8 contains pictures that are never shown, only used for prediction.
bool is_shown(const Container& container, const AVPacket& packet) noexcept {
  if ((packet.flags & AV_PKT_FLAG_DISCARD) != 0) return false;  // removed by an edit list
  return container.stream().codecpar->codec_id != AV_CODEC_ID_VP8 || (packet.data[0] & 0x10) != 0;
}

// In the order of decoding: a frame that is shown before one already decoded was predicted from it.
class PredictionScan {
 public:
  void take(bool is_key, std::int64_t tick) noexcept {
    any_predicted_ = any_predicted_ || !is_key;
    any_reordered_ = any_reordered_ || (any_ && tick < last_);
    last_ = any_ ? std::max(last_, tick) : tick;
    any_ = true;
  }
  [[nodiscard]] core::FramePrediction found() const noexcept {
    if (!any_) return core::FramePrediction::kUnknown;
    if (!any_predicted_) return core::FramePrediction::kNone;
    return any_reordered_ ? core::FramePrediction::kBoth : core::FramePrediction::kPast;
  }

 private:
  bool any_ = false, any_predicted_ = false, any_reordered_ = false;
  std::int64_t last_ = 0;
};

struct Seen {
  std::int64_t tick;
  std::uint32_t bytes;
};

}  // namespace

PacketScan scan_packets(const std::string& path) {
  Container container(path);
  const AvHandle<AVPacket> packet(av_packet_alloc());
  if (!packet) throw std::bad_alloc();
  PacketScan scan;
  scan.tick_s = container.tick_s();
  std::vector<Seen> seen;
  PredictionScan prediction;
  std::int64_t last_dts = AV_NOPTS_VALUE;
  while (scan.n_packets < kMostScanned && container.n_bytes_read() < kMostScannedBytes) {
    if (!container.next(*packet)) {
      if (const std::string fault = container.read_fault(); !fault.empty()) throw std::runtime_error(fault);
      scan.complete = true;
      break;
    }
    if (!is_shown(container, *packet)) continue;
    ++scan.n_packets;
    if (packet->dts >= -kMostTicks && packet->dts <= kMostTicks) {
      const bool runs_back =
          last_dts != AV_NOPTS_VALUE && static_cast<double>(last_dts - packet->dts) * scan.tick_s > kBackward_s;
      if (runs_back && scan.backward_at_s < 0.0 && !seen.empty()) {
        scan.backward_at_s = static_cast<double>(seen.back().tick - seen.front().tick) * scan.tick_s;
      }
      last_dts = packet->dts;
    }
    const std::int64_t tick = packet->pts != AV_NOPTS_VALUE ? packet->pts : packet->dts;
    if (tick < -kMostTicks || tick > kMostTicks) continue;
    seen.push_back({tick, static_cast<std::uint32_t>(packet->size)});
    prediction.take((packet->flags & AV_PKT_FLAG_KEY) != 0, tick);
  }
  scan.prediction = prediction.found();
  if (static_cast<double>(seen.size()) < kWithTimes * static_cast<double>(scan.n_packets)) return scan;
  std::stable_sort(seen.begin(), seen.end(), [](const Seen& a, const Seen& b) { return a.tick < b.tick; });
  if (seen.empty() || static_cast<double>(seen.back().tick - seen.front().tick) * scan.tick_s > kMostSpan_s)
    return scan;
  const AVRational nanosecond{1, 1'000'000'000};
  for (const Seen& one : seen) {
    scan.ticks.push_back(one.tick);
    scan.bytes.push_back(one.bytes);
    scan.times_ns.push_back(av_rescale_q(one.tick - seen.front().tick, container.stream().time_base, nanosecond));
  }
  return scan;
}

}  // namespace drivers
