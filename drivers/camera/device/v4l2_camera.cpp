#include "drivers/camera/device/v4l2_camera.h"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "drivers/camera/device_missing.h"
#include "drivers/camera/line_timing.h"
#include "drivers/camera/stream_pacer.h"

namespace drivers {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kSettleTime{1000};
constexpr milliseconds kSettleLimit{3000};  // for a camera that delivers no frames at first
constexpr milliseconds kSearchPeriod{100};  // between two searches for a lost camera
constexpr milliseconds kSilence{2000};      // after so long without a buffer the stream is set up again
constexpr double kSilentPeriods = 10.0;     // and after at least so many frame periods
constexpr milliseconds kLookPeriod{1000};   // between two checks of the input's status
constexpr double kUnstatedRate_hz = 30.0;

double rate_of(const V4l2Stream& stream, const WantedMode& wanted) noexcept {
  const double stated_hz = stream.made().mode.rate_hz;
  if (stated_hz > 0) return stated_hz;
  return wanted.rate_hz > 0 ? wanted.rate_hz : kUnstatedRate_hz;
}

}  // namespace

V4l2Camera::V4l2Camera(const V4l2CameraConfig& config)
    : config_(config),
      stream_(config.source, config.mode),
      luma_(stream_.made().mode.layout, stream_.made().mode.width_px, stream_.made().mode.height_px,
            stream_.made().stride_bytes) {
  const LineTiming timing = checked_line_timing(config.readout_ms, config.exposure_ms);
  info_.width_px = stream_.made().mode.width_px;
  info_.height_px = stream_.made().mode.height_px;
  info_.rate_hz = rate_of(stream_, config.mode);
  info_.readout_ns = timing.readout_ns;
  info_.readout_direction = config.readout_direction;
  info_.exposure_ns = timing.exposure_ns;
  info_.description = fmt::format("{}, {:.6g} Hz, stamps at the {}", stream_.description(), info_.rate_hz,
                                  stream_.stamps_the_start() ? "start of exposure" : "end of the frame");
  stop_fd_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (stop_fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

V4l2Camera::~V4l2Camera() {
  stop();
  ::close(stop_fd_);
}

void V4l2Camera::start() {
  fault_.clear();
  if (!stream_.is_open() && !stream_.open_again()) {
    throw DeviceMissing(fmt::format("{}: is not attached any more, or cannot be set up again", info_.description));
  }
  if (const int error = stream_.begin(); error != 0) {
    throw std::runtime_error(fmt::format("{}: streaming cannot begin: {}: is there enough USB bandwidth?",
                                         stream_.device().path(), std::strerror(error)));
  }
  std::uint64_t drained = 0;
  (void)!::read(stop_fd_, &drained, sizeof drained);
  gate_.open();
  last_buffer_ = Clock::now();
  clock_.forget();  // the first frame determines the clock, and ends the wait for one
  settle();
  sequence_ = LiveSequence(info_.rate_hz);
}

// Frames are inspected and returned to the driver; the first one determines the clock.
void V4l2Camera::settle() {
  const milliseconds adjusting = stream_.adjusts_itself() ? kSettleTime : milliseconds(0);
  Deadline until = Clock::now() + kSettleLimit;
  while (Clock::now() < until && stream_.wait(until, stop_fd_) == Wait::kReady) {
    V4l2Filled buffer;
    if (stream_.device().dequeue(buffer) != 0) break;
    if (clock_.kind() == StampClock::Kind::kUndecided) {
      (void)clock_.to_monotonic_ns(stamp_ns(buffer), StampClock::now());
      until = Clock::now() + adjusting;
    }
    (void)stream_.device().queue(buffer.index);
  }
  trouble_.clock(clock_.kind());
  locked_ = lock_controls(stream_.device(), {config_.exposure_ms});
  if (locked_.exposure_ms > 0) info_.exposure_ns = static_cast<std::int64_t>(locked_.exposure_ms * 1e6);
}

CaptureStatus V4l2Camera::capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept {
  const CaptureGate::Pass pass(gate_);
  const Deadline deadline = deadline_after(timeout);
  for (;;) {
    if (gate_.is_closed()) return CaptureStatus::kEndOfStream;
    if (!fault_.empty()) return CaptureStatus::kFault;
    if (!stream_.is_open()) find_again();
    const bool is_open = stream_.is_open();
    switch (stream_.wait(is_open ? deadline : std::min(deadline, Clock::now() + kSearchPeriod), stop_fd_)) {
      case Wait::kReady:
        if (const CaptureStatus status = take(out); status != CaptureStatus::kTimeout) return status;
        break;
      case Wait::kBroken:
        interrupt();
        break;
      case Wait::kStopped:
        break;
      case Wait::kDeadline:
        if (is_open && is_silent()) interrupt();
        if (Clock::now() >= deadline) return CaptureStatus::kTimeout;
    }
  }
}

CaptureStatus V4l2Camera::take(core::Frame& out) noexcept {
  V4l2Filled buffer;
  const int error = stream_.device().dequeue(buffer);
  if (error != 0 && error != EAGAIN) interrupt();
  if (error != 0) return CaptureStatus::kTimeout;
  last_buffer_ = Clock::now();
  const bool is_picture = has_signal();
  const bool is_filled = is_picture && fill(buffer, out);
  if (is_picture && !is_filled) trouble_.damaged();
  if (stream_.device().queue(buffer.index) != 0) interrupt();  // the frame already received is complete
  if (!fault_.empty()) return CaptureStatus::kFault;
  return is_filled ? CaptureStatus::kFrame : CaptureStatus::kTimeout;
}

bool V4l2Camera::fill(const V4l2Filled& buffer, core::Frame& out) noexcept {
  if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0 || buffer.bytes == nullptr) return false;
  if (out.pixels.size() != static_cast<std::size_t>(info_.width_px) * static_cast<std::size_t>(info_.height_px)) {
    fault_ = "a frame slot of another size than the camera's image";
    return false;
  }
  if (luma_.read(buffer.bytes, buffer.n_bytes, out.pixels.data()) != LumaStatus::kOk) return false;
  std::int64_t t_ns = clock_.to_monotonic_ns(stamp_ns(buffer), StampClock::now());
  trouble_.clock(clock_.kind());
  if (!stream_.stamps_the_start() || clock_.kind() == StampClock::Kind::kArrival)
    t_ns -= std::abs(info_.readout_ns) + info_.exposure_ns;
  const LiveSequence::Step step = sequence_.next(buffer.sequence, t_ns);
  out.sequence = step.sequence;
  out.gap_before = step.gap_before;
  out.t_start_ns = t_ns;
  out.exposure_ns = info_.exposure_ns;
  out.width_px = info_.width_px;
  out.height_px = info_.height_px;
  trouble_.found();
  return true;
}

bool V4l2Camera::has_signal() noexcept {
  const Deadline now = Clock::now();
  if (now - last_look_ < kLookPeriod) return has_signal_;
  last_look_ = now;
  has_signal_ = stream_.has_signal();
  if (!has_signal_) mark_lost();
  return has_signal_;
}

bool V4l2Camera::is_silent() const noexcept {
  const std::chrono::duration<double> since = Clock::now() - last_buffer_;
  return since > kSilence && since.count() * info_.rate_hz > kSilentPeriods;
}

void V4l2Camera::mark_lost() noexcept {
  sequence_.interrupted();
  trouble_.lost();
}

void V4l2Camera::interrupt() noexcept {
  stream_.give_up();
  mark_lost();
}

void V4l2Camera::find_again() noexcept {
  try {
    if (!stream_.open_again()) return;
    luma_ = LumaReader(stream_.made().mode.layout, info_.width_px, info_.height_px, stream_.made().stride_bytes);
    set_again(stream_.device(), locked_);
    if (stream_.begin() != 0) return stream_.close();
    last_buffer_ = Clock::now();
    last_look_ = {};
    clock_.forget();
  } catch (...) {  // out of memory: the next search may succeed
    stream_.close();
  }
}

void V4l2Camera::stop() noexcept {
  gate_.shut();
  const std::uint64_t one = 1;
  (void)!::write(stop_fd_, &one, sizeof one);
  gate_.wait_until_left();
  stream_.close();
}

}  // namespace drivers
