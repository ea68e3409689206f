#include "drivers/camera/recording/file_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "drivers/camera/line_timing.h"
#include "drivers/camera/recording/timestamp_file.h"

namespace drivers {

namespace {

constexpr std::size_t kQueueSlots = 4;  // evens out key frames, which take several times as long to decode
constexpr double kMinRate_hz = 1e-3;
constexpr double kMaxRate_hz = 1e6;
constexpr double kExpectedShare = 0.98;  // containers round their frame count; a larger loss is reported

bool is_usable_rate(double rate_hz) { return rate_hz >= kMinRate_hz && rate_hz <= kMaxRate_hz; }  // false for NaN

}  // namespace

FileCamera::FileCamera(const FileCameraConfig& config) : path_(config.source), pacer_(config.realtime) {
  if (config.rate_hz != 0.0 && !is_usable_rate(config.rate_hz)) {
    throw std::invalid_argument(fmt::format("camera.rate_hz = {}: must be within {} .. {} Hz, or 0 to take it from {}",
                                            config.rate_hz, kMinRate_hz, kMaxRate_hz, path_));
  }
  const LineTiming timing = checked_line_timing(config.readout_ms, config.exposure_ms);
  source_ = open_frame_source(path_);
  const SourceInfo& source = source_->info();
  info_.width_px = source.width_px;
  info_.height_px = source.height_px;
  info_.readout_ns = timing.readout_ns;
  info_.readout_direction = turn_clockwise(config.readout_direction, source.turned_clockwise_deg);
  info_.exposure_ns = timing.exposure_ns;
  info_.frame_count = source.frame_count;
  info_.lossless = !config.realtime;
  take_times(config);
  info_.description = fmt::format("{}, {:.6g} Hz, times from {}", source.description, info_.rate_hz,
                                  !stamps_ns_.empty()     ? stamp_file_
                                  : config.rate_hz != 0.0 ? std::string("camera.rate_hz")
                                                          : std::string("the container's rate"));
  queue_ = std::make_unique<FrameQueue>(kQueueSlots, info_.width_px, info_.height_px);
}

FileCamera::~FileCamera() { stop(); }

void FileCamera::take_times(const FileCameraConfig& config) {
  const SourceInfo& source = source_->info();
  info_.rate_hz = config.rate_hz;
  stamp_file_ = find_timestamp_file(path_);
  if (!stamp_file_.empty()) {
    stamps_ns_ = read_timestamp_file(stamp_file_);
    // The container's count is a promise (truncated files, edit lists): before refusing, see whether frames are there.
    if (stamps_ns_.size() < source.frame_count && source_->has_more_frames_than(stamps_ns_.size())) {
      throw std::runtime_error(
          fmt::format("{}: {} time stamps for {} frames of {}: write one line per frame, or remove "
                      "the file to use camera.rate_hz instead",
                      stamp_file_, stamps_ns_.size(), source.frame_count, path_));
    }
    info_.frame_count = stamps_ns_.size();
    if (info_.rate_hz == 0.0 && stamps_ns_.size() > 1) info_.rate_hz = mean_rate_hz(stamps_ns_);
    if (is_usable_rate(info_.rate_hz)) return;
    throw std::runtime_error(
        fmt::format("{}: {} stamps give a rate of {} Hz, not within {} .. {}: set camera.rate_hz, "
                    "and check that t_s is in seconds",
                    stamp_file_, stamps_ns_.size(), info_.rate_hz, kMinRate_hz, kMaxRate_hz));
  }
  if (info_.rate_hz != 0.0) return;
  if (!source.has_rate) {
    throw std::runtime_error(
        fmt::format("{}: a folder of images has no frame rate: set camera.rate_hz, or write the "
                    "times into {}/timestamps.csv (header frame,t_s)",
                    path_, path_));
  }
  if (!is_usable_rate(source.rate_hz)) {
    throw std::runtime_error(
        fmt::format("{}: the container states a rate of {} Hz, not within {} .. {}: set "
                    "camera.rate_hz to the true rate",
                    path_, source.rate_hz, kMinRate_hz, kMaxRate_hz));
  }
  info_.rate_hz = source.rate_hz;
}

void FileCamera::start() {
  if (decoder_.joinable()) throw std::runtime_error(fmt::format("{}: started twice without a stop", path_));
  if (source_ == nullptr) {  // given back by stop(): from the beginning
    source_ = open_frame_source(path_);
    if (source_->info().width_px != info_.width_px || source_->info().height_px != info_.height_px)
      throw std::runtime_error(fmt::format("{}: has another image size than before", path_));
    queue_ = std::make_unique<FrameQueue>(kQueueSlots, info_.width_px, info_.height_px);
  }
  pacer_.start();
  decoder_ = std::thread([this] { decode_all(); });
}

void FileCamera::decode_all() {
  for (std::uint64_t frame = 0;; ++frame) {
    core::Frame* slot = queue_->claim();
    if (slot == nullptr) return;
    const ReadStatus status = source_->read(*slot);
    if (status == ReadStatus::kEnd) return queue_->finish(CaptureStatus::kEndOfStream, shortfall(frame));
    if (status == ReadStatus::kFault) return queue_->finish(CaptureStatus::kFault, source_->error());
    if (!stamps_ns_.empty() && frame >= stamps_ns_.size()) {
      return queue_->finish(CaptureStatus::kFault,
                            fmt::format("{}: {} time stamps, but {} has more frames: write one line per frame",
                                        stamp_file_, stamps_ns_.size(), path_));
    }
    slot->sequence = frame;
    slot->t_start_ns = frame_time_ns(frame);
    slot->exposure_ns = info_.exposure_ns;
    slot->gap_before = false;
    queue_->publish();
  }
}

std::int64_t FileCamera::frame_time_ns(std::uint64_t frame) const noexcept {
  if (!stamps_ns_.empty()) return stamps_ns_[frame];
  // Not by adding up: a sum of rounded periods would drift. Clamped where int64 ends (292 years).
  return std::llround(std::min(static_cast<double>(frame) / info_.rate_hz * 1e9, 9.2e18));
}

std::string FileCamera::shortfall(std::uint64_t n_decoded) const {
  const std::uint64_t promised = info_.frame_count;
  if (!stamps_ns_.empty() && n_decoded < promised) {
    return fmt::format("{}: {} time stamps, but only {} frames decoded from {}: the file is truncated or damaged",
                       stamp_file_, promised, n_decoded, path_);
  }
  if (static_cast<double>(n_decoded) >= kExpectedShare * static_cast<double>(promised)) return {};
  return fmt::format("{}: container promises {} frames, decoded {}: the file is truncated or damaged", path_, promised,
                     n_decoded);
}

CaptureStatus FileCamera::capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept {
  const auto deadline = deadline_after(timeout);
  CaptureStatus status = CaptureStatus::kTimeout;
  const core::Frame* frame = queue_->front(deadline, status);
  if (frame == nullptr) return status;
  if (!pacer_.wait(frame->t_start_ns - frame_time_ns(0), deadline)) return CaptureStatus::kTimeout;
  if (out.pixels.size() != frame->pixels.size()) {
    queue_->close(CaptureStatus::kFault, fmt::format("{}: frame slot of {} bytes for images of {} x {} px", path_,
                                                     out.pixels.size(), info_.width_px, info_.height_px));
    return CaptureStatus::kFault;
  }
  std::memcpy(out.pixels.data(), frame->pixels.data(), frame->pixels.size());
  out.sequence = frame->sequence;
  out.t_start_ns = frame->t_start_ns;
  out.exposure_ns = frame->exposure_ns;
  out.gap_before = frame->gap_before;
  out.width_px = frame->width_px;
  out.height_px = frame->height_px;
  queue_->pop();
  return CaptureStatus::kFrame;
}

void FileCamera::stop() noexcept {
  if (queue_ != nullptr) queue_->close(CaptureStatus::kEndOfStream, {});
  pacer_.cancel();
  const std::lock_guard lock(stop_mutex_);
  if (!decoder_.joinable()) return;
  decoder_.join();
  source_.reset();  // gives the file back
}

std::string FileCamera::fault() const { return queue_->end_text(); }

}  // namespace drivers
