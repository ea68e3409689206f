#include "drivers/camera/recording/video_decoder.h"

#include <fmt/format.h>

#include <new>
#include <stdexcept>
#include <utility>

#include "drivers/storage/limits.h"

namespace drivers {

namespace {

constexpr int kMostErrorsInARow = 100'000;  // limit for a decoder that only fails
// A larger size means a damaged header.
constexpr auto kMostPixels = static_cast<std::int64_t>(Limits::kImagePixels);

AvHandle<AVCodecContext> open_codec(const Container& container) {
  AvHandle<AVCodecContext> codec(avcodec_alloc_context3(&container.decoder()));
  if (!codec) throw std::bad_alloc();
  int status = avcodec_parameters_to_context(codec.get(), container.stream().codecpar);
  codec->pkt_timebase = container.stream().time_base;
  codec->thread_count = 0;  // one for each processor
  codec->thread_type = container.is_live() ? FF_THREAD_SLICE : FF_THREAD_FRAME | FF_THREAD_SLICE;
  codec->max_pixels = kMostPixels;
  if (status >= 0) status = avcodec_open2(codec.get(), &container.decoder(), nullptr);
  if (status >= 0) return codec;
  throw std::runtime_error(fmt::format("{}: its video ({}) cannot be decoded: {}; {}", container.name(),
                                       container.codec_name(), av_error_text(status), container.codec_remedy()));
}

}  // namespace

VideoDecoder::VideoDecoder(const std::string& path) : VideoDecoder(Container(path)) {}

VideoDecoder::VideoDecoder(Container container)
    : container_(std::move(container)),
      codec_(open_codec(container_)),
      packet_(av_packet_alloc()),
      picture_(av_frame_alloc()) {
  if (!packet_ || !picture_) throw std::bad_alloc();
}

DecodeStatus VideoDecoder::next() noexcept {
  for (;;) {
    const int status = avcodec_receive_frame(codec_.get(), picture_.get());
    if (status == 0) {
      n_errors_in_a_row_ = 0;
      const bool is_partly_invented =
          picture_->decode_error_flags != 0 || (picture_->flags & AV_FRAME_FLAG_CORRUPT) != 0;
      return is_partly_invented ? DecodeStatus::kDamaged : DecodeStatus::kPicture;
    }
    if (status == AVERROR_EOF) return DecodeStatus::kEnd;
    const bool accepted = status == AVERROR(EAGAIN) && feed();  // else a packet did not decode, here or in a thread
    if (accepted) continue;
    return ++n_errors_in_a_row_ > kMostErrorsInARow ? DecodeStatus::kEnd : DecodeStatus::kDamaged;
  }
}

// The decoder requests input only when it has no picture to return, so that a packet never waits for long.
bool VideoDecoder::feed() noexcept {
  if (!packet_waits_ && !draining_) {
    packet_waits_ = container_.next(*packet_);
    draining_ = !packet_waits_;
  }
  const int status = avcodec_send_packet(codec_.get(), packet_waits_ ? packet_.get() : nullptr);
  if (status == AVERROR(EAGAIN)) return true;
  packet_waits_ = false;
  return status >= 0 || status == AVERROR_EOF;
}

}  // namespace drivers
