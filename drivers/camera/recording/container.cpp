#include "drivers/camera/recording/container.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <tuple>

#include "drivers/camera/recording/libav_versions.h"

extern "C" {
#include <libavutil/display.h>
}

namespace drivers {

namespace {

// Names of libavformat's demuxers. Excluded: play lists, session descriptions and scripts (hls, concat, dash, sdp,
// lavfi), which open other files, and tty, which renders any text file as on a terminal.
constexpr const char* kFormats =
    "mov,matroska,avi,mpegts,mpeg,mpegvideo,h264,hevc,m4v,h263,av1,obu,ivf,vc1,vc1test,mjpeg,mjpeg_2000,flv,live_flv,"
    "asf,ogg,mxf,gxf,dv,nut,yuv4mpegpipe,rm,gif,apng,png_pipe,jpeg_pipe,dirac,cavsvideo,swf,wtv,mpjpeg,film_cpk,nsv,"
    "bmp_pipe,tiff_pipe,webp_pipe,pgm_pipe,ppm_pipe,pgmyuv_pipe,pam_pipe,j2k_pipe,xwd_pipe,dpx_pipe";

constexpr int kMostPictureBytes = 64 << 20;

// Pictures up to this size are decoded to find what a file leaves out. Larger ones are not: before anything is known of
// a file, that would take memory without a bound (video_decoder.cpp has one).
constexpr std::int64_t kMostProbedPixels = 1920 * 1088;

bool has_large_pictures(const AVFormatContext& format) noexcept {
  const auto is_large = [](const AVStream* stream) {
    return std::int64_t{stream->codecpar->width} * stream->codecpar->height > kMostProbedPixels;
  };
  return std::any_of(format.streams, format.streams + format.nb_streams, is_large);
}

int find_stream_info(AVFormatContext& format) {
  if (has_large_pictures(format)) format.codec_whitelist = av_strdup("none");  // opens no decoder at all
  std::vector<AVDictionary*> options(format.nb_streams);
  for (AVDictionary*& one : options) av_dict_set_int(&one, "max_pixels", kMostProbedPixels, 0);
  const int status = avformat_find_stream_info(&format, options.empty() ? nullptr : options.data());
  for (AVDictionary*& one : options) av_dict_free(&one);
  return status;
}

AvHandle<AVFormatContext> open_format(const std::string& path) {
  AVFormatContext* context = avformat_alloc_context();
  if (context == nullptr) throw std::bad_alloc();
  AVDictionary* options = nullptr;
  av_dict_set(&options, "format_whitelist", kFormats, 0);
  av_dict_set(&options, "protocol_whitelist", "file", 0);
  // "file:" and absolute: a name such as "concat:a" must not be interpreted as a protocol.
  const std::string url = "file:" + std::filesystem::absolute(path).string();
  const int status = avformat_open_input(&context, url.c_str(), nullptr, &options);  // frees the context on failure
  av_dict_free(&options);
  AvHandle<AVFormatContext> format(status < 0 ? nullptr : context);
  if (!format || find_stream_info(*format) < 0) {
    throw std::runtime_error(
        fmt::format("{}: not a video that can be opened: an unknown format, or an MP4 whose index is missing because "
                    "the recording was cut off; if ffplay shows it, convert it: ffmpeg -i IN -crf 12 OUT.mp4; else "
                    "record it again",
                    path));
  }
  return format;
}

AvHandle<AVFormatContext> open_live(const LiveSender& sender) {
  AVFormatContext* context = avformat_alloc_context();
  if (context == nullptr) throw std::bad_alloc();
  context->interrupt_callback = sender.interrupt;
  if (sender.in_parts) context->flags |= AVFMT_FLAG_NOPARSE;
  AVDictionary* options = nullptr;
  av_dict_copy(&options, sender.options, 0);
  int status = avformat_open_input(&context, sender.url.c_str(), nullptr, &options);  // frees the context on failure
  av_dict_free(&options);
  AvHandle<AVFormatContext> format(status < 0 ? nullptr : context);
  if (format) status = find_stream_info(*format);
  if (status >= 0) return format;
  throw std::runtime_error(fmt::format("{}: no video from there: {}", sender.shown,
                                       status == AVERROR_EXIT ? "no answer in time" : av_error_text(status)));
}

bool is_picture_beside(const AVStream& stream) noexcept {
  return (stream.disposition & (AV_DISPOSITION_ATTACHED_PIC | AV_DISPOSITION_TIMED_THUMBNAILS)) != 0;
}

bool has_tag(const AVStream& stream, const char* tag) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8U | static_cast<std::uint8_t>(tag[i]);
  return stream.codecpar->codec_type == AVMEDIA_TYPE_DATA && stream.codecpar->codec_tag == value;
}

std::string stream_words(const AVStream& stream) {
  const AVCodecParameters& p = *stream.codecpar;
  if (p.codec_type == AVMEDIA_TYPE_VIDEO && is_picture_beside(stream)) return "a cover picture";
  const char* type = av_get_media_type_string(p.codec_type);
  const std::string kind = type != nullptr ? type : "unknown";
  return p.codec_id == AV_CODEC_ID_NONE ? kind : fmt::format("{} {}", kind, avcodec_get_name(p.codec_id));
}

}  // namespace

std::string av_error_text(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  return av_strerror(code, text.data(), text.size()) == 0 ? text.data() : fmt::format("error {}", code);
}

Container::Container(const std::string& path) : path_(path), format_(open_format(path)) {
  choose_stream();
  discard_others();
}

Container::Container(const LiveSender& sender)
    : path_(sender.shown),
      is_live_(true),
      ahead_(sender.in_parts ? av_packet_alloc() : nullptr),
      format_(open_live(sender)) {
  if (sender.in_parts && !ahead_) throw std::bad_alloc();
  choose_stream();
  discard_others();
}

Container::Container(const std::string& path, const char* data_tag) : path_(path), format_(open_format(path)) {
  for (unsigned i = 0; i < format_->nb_streams && stream_ == nullptr; ++i) {
    if (has_tag(*format_->streams[i], data_tag)) stream_ = format_->streams[i];
  }
  discard_others();
}

bool Container::has_data(const char* tag) const noexcept {
  for (unsigned i = 0; i < format_->nb_streams; ++i) {
    if (has_tag(*format_->streams[i], tag)) return true;
  }
  return false;
}

void Container::discard_others() noexcept {
  for (unsigned i = 0; i < format_->nb_streams; ++i) {
    if (format_->streams[i] != stream_) format_->streams[i]->discard = AVDISCARD_ALL;
  }
}

// A JPEG stream of one picture is a cover, whatever its flags, unless there is no other stream.
bool Container::may_be_the_film(const AVStream& stream) const noexcept {
  return stream.codecpar->codec_type == AVMEDIA_TYPE_VIDEO && !is_picture_beside(stream);
}

void Container::choose_stream() {
  std::tuple<bool, bool, std::int64_t> best{};
  std::string unreadable;
  for (unsigned i = 0; i < format_->nb_streams; ++i) {
    AVStream& stream = *format_->streams[i];
    if (!may_be_the_film(stream)) continue;
    const AVCodec* decoder = avcodec_find_decoder(stream.codecpar->codec_id);
    if (decoder == nullptr) {
      unreadable = fmt::format("{}: no decoder for its video ({}); {}", path_,
                               avcodec_get_name(stream.codecpar->codec_id), codec_remedy());
      continue;
    }
    const std::tuple<bool, bool, std::int64_t> rank{
        stream.nb_frames != 1, (stream.disposition & AV_DISPOSITION_DEFAULT) != 0,
        static_cast<std::int64_t>(stream.codecpar->width) * stream.codecpar->height};
    if (stream_ != nullptr && rank <= best) continue;
    stream_ = &stream, decoder_ = decoder, best = rank;
  }
  if (stream_ != nullptr) return;
  if (!unreadable.empty()) throw std::runtime_error(unreadable);
  const std::string found = other_streams();
  throw std::runtime_error(fmt::format("{}: not a video: it has no moving picture ({}): check camera.source", path_,
                                       found.empty() ? "no stream at all" : "found: " + found));
}

const char* Container::codec_remedy() const noexcept {
  return is_live_ ? "send H.264, HEVC or MJPEG" : "convert it: ffmpeg -i IN -crf 12 OUT.mp4";
}

// libavformat's parser would do this too, but gives a picture the time of the one before, of which only the headers
// came.
bool Container::next(AVPacket& packet) noexcept {
  if (!ahead_) return read(packet);
  av_packet_unref(&packet);
  if (ahead_->size == 0 && !read(*ahead_)) return false;
  av_packet_move_ref(&packet, ahead_.get());
  while (read(*ahead_) && ahead_->pts == packet.pts) {
    if (!append(packet)) return false;
  }
  return true;
}

bool Container::append(AVPacket& packet) noexcept {
  const auto at = static_cast<std::size_t>(packet.size);
  if (packet.size > kMostPictureBytes - ahead_->size || av_grow_packet(&packet, ahead_->size) < 0) return false;
  std::memcpy(packet.data + at, ahead_->data, static_cast<std::size_t>(ahead_->size));
  return true;
}

bool Container::read(AVPacket& packet) noexcept {
  for (;;) {
    av_packet_unref(&packet);
    const int status = av_read_frame(format_.get(), &packet);
    // Some demuxers take a failed read for the end of the file.
    const int of_disk = format_->pb != nullptr ? format_->pb->error : 0;
    if (of_disk < 0 && of_disk != AVERROR_EOF) {
      av_packet_unref(&packet);
      read_error_ = of_disk;
      return false;
    }
    if (status < 0) return false;
    if (packet.stream_index == stream_->index && packet.size > 0) return true;
  }
}

std::string Container::read_fault() const {
  if (read_error_ == 0) return {};
  return fmt::format("{}: reading failed: {}; check the disk, or copy the file again", path_,
                     av_error_text(read_error_));
}

std::string Container::codec_name() const { return avcodec_get_name(stream_->codecpar->codec_id); }

int Container::coding_block_px() const noexcept {
  const AVCodecDescriptor* codec = avcodec_descriptor_get(stream_->codecpar->codec_id);
  if (codec == nullptr || (codec->props & AV_CODEC_PROP_INTRA_ONLY) != 0) return 0;
  switch (codec->id) {
    case AV_CODEC_ID_HEVC:
    case AV_CODEC_ID_VP9:
      return 64;
    case AV_CODEC_ID_AV1:
    case AV_CODEC_ID_VVC:
      return 128;
    default:  // H.264, MPEG-4 and their forerunners
      return 16;
  }
}

int Container::clockwise_turn_deg() const noexcept {
  const std::int32_t* matrix = display_matrix(*stream_);
  if (matrix == nullptr) return 0;
  const double counter_clockwise = av_display_rotation_get(matrix);
  if (!std::isfinite(counter_clockwise)) return 0;
  const double quarters = -counter_clockwise / 90.0;
  if (std::abs(quarters - std::nearbyint(quarters)) > 0.01) return 0;  // quarter turns only
  return (static_cast<int>(std::nearbyint(quarters)) % 4 + 4) % 4 * 90;
}

std::uint64_t Container::promised_frames() const noexcept {
  if (stream_->nb_frames > 0) return static_cast<std::uint64_t>(stream_->nb_frames);
  const std::vector<double> rates_hz = stated_rates_hz();
  double duration_s = stream_->duration > 0 ? static_cast<double>(stream_->duration) * tick_s() : 0.0;
  if (duration_s == 0.0 && format_->duration > 0) duration_s = static_cast<double>(format_->duration) / AV_TIME_BASE;
  const double promised = rates_hz.empty() ? 0.0 : std::floor(duration_s * rates_hz.front() + 0.5);
  return promised >= 1.0 && promised < 1e12 ? static_cast<std::uint64_t>(promised) : 0;
}

std::vector<double> Container::stated_rates_hz() const {
  std::vector<double> rates_hz;
  for (const AVRational rate :
       {av_guess_frame_rate(format_.get(), stream_, nullptr), stream_->r_frame_rate, stream_->avg_frame_rate}) {
    if (rate.num <= 0 || rate.den <= 0) continue;
    const double rate_hz = av_q2d(rate);
    if (std::find(rates_hz.begin(), rates_hz.end(), rate_hz) == rates_hz.end()) rates_hz.push_back(rate_hz);
  }
  return rates_hz;
}

std::string Container::other_streams() const {
  std::string words;
  constexpr unsigned kMostNamed = 6;
  for (unsigned i = 0; i < std::min(format_->nb_streams, kMostNamed); ++i) {
    if (format_->streams[i] == stream_) continue;
    words += (words.empty() ? "" : ", ") + stream_words(*format_->streams[i]);
  }
  return words + (format_->nb_streams > kMostNamed ? ", ..." : "");
}

std::uint64_t Container::n_bytes_read() const noexcept {
  const std::int64_t at = format_->pb != nullptr ? avio_tell(format_->pb) : 0;
  return at > 0 ? static_cast<std::uint64_t>(at) : 0;
}

}  // namespace drivers
