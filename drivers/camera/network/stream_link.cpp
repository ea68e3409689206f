#include "drivers/camera/network/stream_link.h"

#include "drivers/camera/recording/frame_source.h"

extern "C" {
#include <libavutil/dict.h>
#include <libavutil/mathematics.h>
}

namespace drivers {
namespace {

constexpr std::int64_t kMostStamp_ns = std::int64_t{1} << 60;  // 36 years: sums of two do not overflow

class Options {
 public:
  explicit Options(const StreamAddress& address) {
    for (const auto& [key, value] : address.options) av_dict_set(&entries_, key.c_str(), value.c_str(), 0);
    av_dict_set(&entries_, "format_whitelist", address.format, 0);
    av_dict_set(&entries_, "protocol_whitelist", address.protocols, 0);
  }
  ~Options() { av_dict_free(&entries_); }
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;
  [[nodiscard]] AVDictionary* get() const noexcept { return entries_; }

 private:
  AVDictionary* entries_ = nullptr;
};

}  // namespace

int StreamLink::is_over(void* wait) noexcept {
  const auto& own = *static_cast<const Wait*>(wait);
  return own.is_cancelled->load() || std::chrono::steady_clock::now() > own.until ? 1 : 0;
}

Container StreamLink::connect(const StreamAddress& address, Wait& wait) {
  silence_media_libraries();
  const Options options(address);
  return Container(
      LiveSender{address.url, address.shown, options.get(), address.in_parts, {&StreamLink::is_over, &wait}});
}

StreamLink::StreamLink(const StreamAddress& address, int decoder_mb, Patience patience,
                       const std::atomic<bool>& is_cancelled)
    : wait_(std::make_unique<Wait>(Wait{&is_cancelled, std::chrono::steady_clock::now() + patience})),
      decoder_(connect(address, *wait_), decoder_mb) {}

DecodeStatus StreamLink::next(Patience patience) noexcept {
  wait_->until = std::chrono::steady_clock::now() + patience;
  return decoder_.next();
}

std::optional<std::int64_t> StreamLink::sent_ns() const noexcept {
  const std::int64_t ticks = picture().best_effort_timestamp;
  if (ticks == AV_NOPTS_VALUE) return std::nullopt;
  const std::int64_t ns = av_rescale_q(ticks, container().stream().time_base, AVRational{1, 1'000'000'000});
  return ns > -kMostStamp_ns && ns < kMostStamp_ns ? std::optional(ns) : std::nullopt;
}

}  // namespace drivers
