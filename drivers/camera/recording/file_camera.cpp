#include "drivers/camera/recording/file_camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "drivers/camera/frame_copy.h"
#include "drivers/camera/line_timing.h"
#include "drivers/camera/recording/clip_telemetry.h"
#include "drivers/camera/recording/repeat_watch.h"

namespace drivers {

namespace {

constexpr std::size_t kQueueSlots = 2;   // one is decoded while one is copied; the ring behind evens out key frames
constexpr double kExpectedShare = 0.98;  // containers round their frame count; a larger loss is reported

std::uintmax_t size_of(const std::string& path) {
  std::error_code error;
  const std::uintmax_t n_bytes = std::filesystem::file_size(path, error);
  return error ? 0 : n_bytes;  // not defined for a folder of images
}

std::int64_t usual_exposure_ns(const ClipTelemetry& telemetry) {
  std::vector<double> exposures_s;
  for (const TimedValue& one : telemetry.exposure_s) exposures_s.push_back(one.value);
  if (exposures_s.empty()) return 0;
  const auto middle = exposures_s.begin() + static_cast<std::ptrdiff_t>(exposures_s.size() / 2);
  std::nth_element(exposures_s.begin(), middle, exposures_s.end());
  return std::llround(*middle * 1e9);
}

}  // namespace

FileCamera::FileCamera(const FileCameraConfig& config)
    : path_(config.source), decoder_mb_(config.decoder_mb), pacer_(config.realtime) {
  if (config.rate_hz != 0.0 && !is_usable_rate(config.rate_hz)) {
    throw std::invalid_argument(fmt::format("camera.rate_hz = {}: must be within {} .. {} Hz, or 0 to take it from {}",
                                            config.rate_hz, kMinRate_hz, kMaxRate_hz, path_));
  }
  const LineTiming timing = checked_line_timing(config.readout_ms, config.exposure_ms);
  n_bytes_ = size_of(path_);
  source_ = open_frame_source(path_, config.decoder_mb);
  const SourceInfo& source = source_->info();
  info_.width_px = source.width_px;
  info_.height_px = source.height_px;
  info_.readout_ns = timing.readout_ns;
  info_.readout_direction = turn_clockwise(config.readout_direction, source.turned_clockwise_deg);
  const ClipTelemetry telemetry = find_telemetry(path_, source.holds_gpmf);
  refuse_zoom(path_, telemetry);
  info_.exposure_ns = timing.exposure_ns != 0 ? timing.exposure_ns : usual_exposure_ns(telemetry);
  info_.lossless = !config.realtime;
  info_.coding_block_px = source.coding_block_px;
  clock_ = make_frame_clock(path_, *source_, config.rate_hz, telemetry);
  if (telemetry.found())
    telemetry_words_ = fmt::format("from {}: {}", telemetry.from, fmt::join(telemetry_words(telemetry), ", "));
  info_.rate_hz = clock_.rate_hz();
  info_.frame_count = clock_.n_stamps() > 0 ? clock_.n_stamps() : source.frame_count;
  if (clock_.cadence()) info_.frame_count = clock_.place(info_.frame_count).cell;
  watches_repeats_ = source.scan != nullptr;
  info_.description =
      fmt::format("{}, {:.6g} Hz, times from {}", source.description, info_.rate_hz, clock_.times().from);
  queue_ = std::make_unique<FrameQueue>(kQueueSlots, info_.width_px, info_.height_px);
}

FileCamera::~FileCamera() { stop(); }

void FileCamera::start() {
  if (decoder_.joinable()) throw std::runtime_error(fmt::format("{}: started twice without a stop", path_));
  if (source_ == nullptr) {  // closed by stop(): start from the beginning
    source_ = open_frame_source(path_, decoder_mb_);
    if (source_->info().width_px != info_.width_px || source_->info().height_px != info_.height_px)
      throw std::runtime_error(fmt::format("{}: has another image size than before", path_));
    queue_ = std::make_unique<FrameQueue>(kQueueSlots, info_.width_px, info_.height_px);
  }
  n_repeated_.store(0, std::memory_order_relaxed);
  pacer_.start();
  decoder_ = std::thread([this] {
    try {
      decode_all();
    } catch (const std::bad_alloc&) {
      queue_->finish(CaptureStatus::kFault, "out of memory");  // short enough to need none
    }
  });
}

void FileCamera::decode_all() {
  RepeatFilter repeats;
  std::uint64_t n_decoded = 0;
  next_sequence_ = 0;
  for (;;) {
    core::Frame* slot = queue_->claim();
    if (slot == nullptr) return;
    const ReadStatus status = source_->read(*slot);
    note_trouble();
    if (status != ReadStatus::kFrame) {
      if (repeats.end(*slot)) publish(*slot);
      return status == ReadStatus::kEnd ? queue_->finish(CaptureStatus::kEndOfStream, shortfall(n_decoded))
                                        : queue_->finish(CaptureStatus::kFault, source_->error());
    }
    ++n_decoded;
    if (clock_.n_stamps() > 0 && source_->index() >= clock_.n_stamps()) {
      return queue_->finish(CaptureStatus::kFault,
                            fmt::format("{}: {} time stamps, but {} has more frames: write one line per frame",
                                        clock_.stamp_file(), clock_.n_stamps(), path_));
    }
    const FrameClock::Place place = clock_.place(source_->index());
    slot->sequence = place.cell;
    slot->t_start_ns = place.t_ns;
    slot->exposure_ns = info_.exposure_ns;
    slot->gap_before = false;
    RepeatFilter::Ready ready{.current = true};
    if (watches_repeats_) ready = repeats.push(*slot, place.repeats);
    n_repeated_.store(repeats.n_repeated(), std::memory_order_relaxed);
    if (ready.held) {
      repeats.exchange(*slot);
      publish(*slot);
      slot = queue_->claim();
      if (slot == nullptr) return;
      repeats.exchange(*slot);
    }
    if (ready.current) publish(*slot);  // otherwise the slot is claimed again
  }
}

void FileCamera::publish(core::Frame& slot) {
  slot.sequence = std::max(slot.sequence, next_sequence_);
  next_sequence_ = slot.sequence + 1;
  queue_->publish();
}

void FileCamera::note_trouble() noexcept {
  const SourceTrouble trouble = source_->trouble();
  n_damaged_.store(trouble.n_damaged, std::memory_order_relaxed);
  n_after_damage_.store(trouble.n_after_damage, std::memory_order_relaxed);
}

core::RecordingTimes FileCamera::times() const {
  core::RecordingTimes out = clock_.times();
  if (!telemetry_words_.empty()) out.remark += (out.remark.empty() ? "" : "; ") + telemetry_words_;
  out.n_damaged = n_damaged_.load(std::memory_order_relaxed);
  out.n_after_damage = n_after_damage_.load(std::memory_order_relaxed);
  out.n_repeated = n_repeated_.load(std::memory_order_relaxed);
  return out;
}

DeviceTrouble FileCamera::trouble() const noexcept {
  DeviceTrouble out;
  out.n_damaged = n_damaged_.load(std::memory_order_relaxed);
  return out;
}

std::string FileCamera::shortfall(std::uint64_t n_decoded) const {
  if (const std::uintmax_t n_bytes = size_of(path_); n_bytes > n_bytes_) {
    return fmt::format(
        "{}: the file grew from {} to {} bytes while it was read: it is still being recorded or copied; {} frames were "
        "read, analyse it again when it is complete",
        path_, n_bytes_, n_bytes, n_decoded);
  }
  if (const std::uint64_t n_stamps = clock_.n_stamps(); n_decoded < n_stamps) {
    return fmt::format("{}: {} time stamps, but only {} frames decoded from {}: the file is truncated or damaged",
                       clock_.stamp_file(), n_stamps, n_decoded, path_);
  }
  if (clock_.n_stamps() > 0) return {};
  const std::uint64_t promised = source_->info().promised_frames;
  if (static_cast<double>(n_decoded) >= kExpectedShare * static_cast<double>(promised)) return {};
  return fmt::format("{}: container promises {} frames, decoded {}: the file is truncated or damaged", path_, promised,
                     n_decoded);
}

CaptureStatus FileCamera::capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept {
  const auto deadline = deadline_after(timeout);
  CaptureStatus status = CaptureStatus::kTimeout;
  const core::Frame* frame = queue_->front(deadline, status);
  if (frame == nullptr) return status;
  if (!pacer_.wait(frame->t_start_ns - clock_.place(0).t_ns, deadline)) return CaptureStatus::kTimeout;
  if (!copy_frame(*frame, out)) {
    queue_->close(CaptureStatus::kFault, fmt::format("{}: frame slot of {} bytes for images of {} x {} px", path_,
                                                     out.pixels.size(), info_.width_px, info_.height_px));
    return CaptureStatus::kFault;
  }
  queue_->pop();
  return CaptureStatus::kFrame;
}

void FileCamera::stop() noexcept {
  if (queue_ != nullptr) queue_->close(CaptureStatus::kEndOfStream, {});
  pacer_.cancel();
  const std::lock_guard lock(stop_mutex_);
  if (!decoder_.joinable()) return;
  decoder_.join();
  source_.reset();  // closes the file
}

std::string FileCamera::fault() const { return queue_->end_text(); }

}  // namespace drivers
