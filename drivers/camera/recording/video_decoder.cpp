#include "drivers/camera/recording/video_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

#include "drivers/storage/limits.h"

extern "C" {
#include <libavutil/cpu.h>
}

namespace drivers {

namespace {

constexpr int kMostThreads = 16;
constexpr int kMostErrorsInARow = 100'000;  // limit for a decoder that only fails
// A larger size means a damaged header.
constexpr auto kMostPixels = static_cast<std::int64_t>(Limits::kImagePixels);

// As many as libavcodec would choose.
int most_threads() noexcept { return std::min(av_cpu_count() + 1, kMostThreads); }

}  // namespace

VideoDecoder::VideoDecoder(const std::string& path, int most_mb) : VideoDecoder(Container(path), most_mb) {
  if (codec_->codec_id != AV_CODEC_ID_H264) return;
  decode_beginning();
  if (memory_->is_exceeded()) return;
  const Prediction found{memory_->n_references(), codec_->has_b_frames};
  container_ = Container(path);
  open_codec(most_threads(), found);
}

VideoDecoder::VideoDecoder(Container container, int most_mb)
    : container_(std::move(container)), most_mb_(most_mb), packet_(av_packet_alloc()), picture_(av_frame_alloc()) {
  if (!packet_ || !picture_) throw std::bad_alloc();
  const bool tells_with_its_pictures = container_.decoder().id == AV_CODEC_ID_H264;
  open_codec(tells_with_its_pictures || container_.is_live() ? 1 : most_threads(), {});
}

void VideoDecoder::open_codec(int n_most_threads, const Prediction& prediction) {
  codec_.reset();
  av_frame_unref(picture_.get());  // counted by memory_
  memory_ = std::make_unique<DecoderMemory>(most_mb_);
  packet_waits_ = draining_ = false;
  n_errors_in_a_row_ = 0;
  codec_.reset(avcodec_alloc_context3(&container_.decoder()));
  if (!codec_) throw std::bad_alloc();
  int status = avcodec_parameters_to_context(codec_.get(), container_.stream().codecpar);
  codec_->pkt_timebase = container_.stream().time_base;
  codec_->thread_count = memory_->watch(*codec_, n_most_threads, prediction.n_references);
  codec_->has_b_frames = std::max(codec_->has_b_frames, prediction.n_delayed);
  if (memory_->is_exceeded()) throw std::runtime_error(fault());
  if (container_.is_live()) codec_->thread_count = 0;  // one for each processor, all of them on one picture
  codec_->thread_type = container_.is_live() ? FF_THREAD_SLICE : FF_THREAD_FRAME | FF_THREAD_SLICE;
  codec_->max_pixels = kMostPixels;
  if (status >= 0) status = avcodec_open2(codec_.get(), &container_.decoder(), nullptr);
  if (status >= 0) return;
  throw std::runtime_error(fmt::format("{}: its video ({}) cannot be decoded: {}; {}", container_.name(),
                                       container_.codec_name(), av_error_text(status), container_.codec_remedy()));
}

// H.264 may state neither. As many pictures as libavformat would decode for it, but within the bound on memory.
void VideoDecoder::decode_beginning() noexcept {
  for (int i = 0; i < (codec_->has_b_frames < 3 ? 7 : 20); ++i) {
    if (next() == DecodeStatus::kEnd) return;
  }
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
    if (memory_->is_exceeded()) return DecodeStatus::kEnd;
    if (accepted) continue;
    return ++n_errors_in_a_row_ > kMostErrorsInARow ? DecodeStatus::kEnd : DecodeStatus::kDamaged;
  }
}

std::string VideoDecoder::fault() const {
  if (!memory_->is_exceeded()) return container_.read_fault();
  const char* remedy =
      container_.is_live() ? "send smaller ones" : "reduce them: ffmpeg -i IN -vf scale=1920:-2 -crf 12 OUT.mp4";
  return fmt::format("{}: {}; {}, or raise it", container_.name(), memory_->words(*codec_), remedy);
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
