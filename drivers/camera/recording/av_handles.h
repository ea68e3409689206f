#pragma once

#include <memory>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace drivers {

// Owners of objects allocated by libavformat and libavcodec.
struct AvDeleter {
  void operator()(AVFormatContext* context) const noexcept { avformat_close_input(&context); }
  void operator()(AVCodecContext* context) const noexcept { avcodec_free_context(&context); }
  void operator()(AVPacket* packet) const noexcept { av_packet_free(&packet); }
  void operator()(AVFrame* frame) const noexcept { av_frame_free(&frame); }
};
template <class T>
using AvHandle = std::unique_ptr<T, AvDeleter>;

[[nodiscard]] std::string av_error_text(int code);

}  // namespace drivers
