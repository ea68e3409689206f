#include "drivers/camera/recording/decoder_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <new>

#include "drivers/camera/recording/hevc_references.h"
#include "drivers/camera/recording/libav_versions.h"

extern "C" {
#include <libavutil/imgutils.h>
}

namespace drivers {

namespace {

constexpr int kUsualReferences = 5;      // of cameras, where none are stated
constexpr int kReferencesOfVp9 = 8;      // and of AV1, in every stream
constexpr double kBesideOfMotion = 0.4;  // of a picture: motion vectors and block types (H.264 0.3, HEVC 0.42)
constexpr int kRowAlignment = 64;

bool is_intra_only(const AVCodecContext& codec) noexcept {
  return codec.codec_descriptor != nullptr && (codec.codec_descriptor->props & AV_CODEC_PROP_INTRA_ONLY) != 0;
}

// As stated before a picture is decoded; 0: not stated.
int stated_references(const AVCodecContext& codec) noexcept {
  switch (codec.codec_id) {
    case AV_CODEC_ID_VP9:
    case AV_CODEC_ID_AV1:
      return kReferencesOfVp9;
    case AV_CODEC_ID_HEVC:  // libavcodec holds one more, which it hands out
      return hevc_references({codec.extradata, static_cast<std::size_t>(std::max(codec.extradata_size, 0))});
    default:
      return 0;
  }
}

// Pictures held at a time by one thread, the one decoded among them.
int n_pictures(const AVCodecContext& codec, int n_references) noexcept {
  return is_intra_only(codec) ? 1 : n_references + 1;
}

// With several threads: one for each, and one handed out.
int n_more(int n_threads) noexcept { return n_threads > 1 ? n_threads + 1 : 0; }

struct Count {
  std::atomic<std::int64_t>* n_held_bytes;
  std::int64_t n_bytes;
};

}  // namespace

std::int64_t DecoderMemory::bytes_of(const AVCodecContext& codec, int width_px, int height_px) const noexcept {
  const AVPixelFormat format = codec.pix_fmt == AV_PIX_FMT_NONE ? AV_PIX_FMT_YUV420P : codec.pix_fmt;
  const int n_bytes = av_image_get_buffer_size(format, width_px, height_px, kRowAlignment);
  const double beside = is_intra_only(codec) ? 0.0 : kBesideOfMotion;
  return static_cast<std::int64_t>(std::max(n_bytes, 0) * (1.0 + beside));
}

int DecoderMemory::watch(AVCodecContext& codec, int most_threads, int n_references) {
  codec.opaque = this;
  codec.get_buffer2 = &DecoderMemory::get_buffer;
  allow_threads_to_call_back(codec);
  if (codec.codec_descriptor == nullptr) codec.codec_descriptor = avcodec_descriptor_get(codec.codec_id);
  const std::int64_t n_bytes = std::max<std::int64_t>(bytes_of(codec, codec.width, codec.height), 1);
  const auto n_fit = static_cast<int>(std::min<std::int64_t>(most_bytes_ / n_bytes, 1'000'000));
  const int n_stated = n_references > 0 ? n_references : stated_references(codec);
  const int n_least = n_pictures(codec, std::max(n_stated, 1));
  if (n_fit < n_least) refuse(n_least * n_bytes);
  const int n_usual = n_pictures(codec, n_stated > 0 ? n_stated : kUsualReferences);
  n_threads_ = std::clamp(n_fit - n_usual - 1, 1, std::max(most_threads, 1));
  return n_threads_;
}

void DecoderMemory::refuse(std::int64_t n_needed_bytes) noexcept {
  std::int64_t none = 0;
  n_needed_bytes_.compare_exchange_strong(none, n_needed_bytes, std::memory_order_relaxed);
}

std::string DecoderMemory::words(const AVCodecContext& codec) const {
  const std::int64_t n_needed_mb = (n_needed_bytes_.load(std::memory_order_relaxed) + 999'999) / 1'000'000;
  return fmt::format("its pictures of {} x {} px take {} MB or more to decode, above camera.decoder_mb: {}",
                     codec.width, codec.height, n_needed_mb, most_bytes_ / 1'000'000);
}

// A decoder announces its reference pictures before it asks for the first buffer, or not at all: then the pictures that
// it holds are counted as they come.
int DecoderMemory::get_buffer(AVCodecContext* codec, AVFrame* picture, int flags) noexcept {
  auto& own = *static_cast<DecoderMemory*>(codec->opaque);
  const std::int64_t n_bytes = own.bytes_of(*codec, picture->width, picture->height);
  own.n_references_.store(std::max(codec->refs, 1), std::memory_order_relaxed);
  const std::int64_t n_announced = n_bytes * (n_pictures(*codec, std::max(codec->refs, 1)) + n_more(own.n_threads_));
  const std::int64_t n_held = own.n_held_bytes_.fetch_add(n_bytes, std::memory_order_relaxed) + n_bytes;
  const std::int64_t n_needed = std::max(n_announced, n_held);
  std::unique_ptr<Count> count;
  if (n_needed <= own.most_bytes_) {
    count.reset(new (std::nothrow) Count{&own.n_held_bytes_, n_bytes});
  } else {
    own.refuse(n_needed);
  }
  int status = count ? avcodec_default_get_buffer2(codec, picture, flags) : AVERROR(ENOMEM);
  if (status >= 0) {
    picture->opaque_ref = av_buffer_create(reinterpret_cast<std::uint8_t*>(count.get()), sizeof(Count), put_back,
                                           nullptr, AV_BUFFER_FLAG_READONLY);
    if (picture->opaque_ref != nullptr) return (void)count.release(), status;
    status = AVERROR(ENOMEM);
  }
  own.n_held_bytes_.fetch_sub(n_bytes, std::memory_order_relaxed);
  return status;
}

void DecoderMemory::put_back(void* /*opaque*/, std::uint8_t* data) noexcept {
  const std::unique_ptr<Count> count(reinterpret_cast<Count*>(data));
  count->n_held_bytes->fetch_sub(count->n_bytes, std::memory_order_relaxed);
}

}  // namespace drivers
