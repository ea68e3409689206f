#include "drivers/camera/device/libcamera_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "drivers/camera/device_missing.h"
#include "drivers/camera/line_timing.h"
#include "drivers/camera/stream_pacer.h"

namespace drivers {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kSettleTime{1000};
constexpr milliseconds kSettleLimit{4000};  // for a camera that delivers no frames at first
constexpr milliseconds kSearchPeriod{100};  // between two searches for a lost camera
constexpr milliseconds kFirstLook{250};     // after so long without a request, check whether the camera is still there
constexpr milliseconds kSilence{3000};      // after so long without a request, set the stream up again
constexpr double kUnstatedRate_hz = 30.0;   // assumed until frames were received

}  // namespace

LibcameraCamera::LibcameraCamera(const LibcameraCameraConfig& config)
    : config_(config), session_(config.wishes, wakeup_) {
  const LineTiming timing = checked_line_timing(config.readout_ms, config.wishes.exposure_ms);
  info_.width_px = session_.width_px();
  info_.height_px = session_.height_px();
  info_.rate_hz = config.wishes.rate_hz > 0 ? config.wishes.rate_hz : kUnstatedRate_hz;
  info_.readout_ns = timing.readout_ns;
  info_.readout_direction = config.readout_direction;
  info_.exposure_ns = timing.exposure_ns;
  info_.description = session_.description();
}

LibcameraCamera::~LibcameraCamera() { stop(); }

void LibcameraCamera::start() {
  fault_.clear();
  if (const std::string refused = session_.run(); !refused.empty())
    throw DeviceMissing(
        fmt::format("{}: {}: is it attached, and used by no other program?", info_.description, refused));
  last_request_ = Clock::now();
  gate_.open();
  settle();
  sequence_ = LiveSequence(info_.rate_hz);
}

// Frames are inspected and returned to the camera.
void LibcameraCamera::settle() {
  core::Frame frame;
  frame.pixels.resize(static_cast<std::size_t>(info_.width_px) * static_cast<std::size_t>(info_.height_px));
  const Deadline limit = Clock::now() + kSettleLimit;
  Deadline until = limit;
  std::int64_t first_ns = 0;
  std::uint64_t first = 0;
  for (bool is_first = true; Clock::now() < until;) {
    if (capture(frame, milliseconds(200)) != CaptureStatus::kFrame) continue;
    if (!is_first) continue;
    is_first = false;
    first_ns = frame.t_start_ns;
    first = frame.sequence;
    until = std::min(limit, Clock::now() + kSettleTime);
  }
  lock_controls_ = true;
  if (frame.exposure_ns > 0) info_.exposure_ns = frame.exposure_ns;
  const double span_s = static_cast<double>(frame.t_start_ns - first_ns) * 1e-9;
  if (config_.wishes.rate_hz == 0 && span_s > 0) info_.rate_hz = static_cast<double>(frame.sequence - first) / span_s;
}

CaptureStatus LibcameraCamera::capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept {
  const CaptureGate::Pass pass(gate_);
  const Deadline deadline = deadline_after(timeout);
  for (;;) {
    if (gate_.is_closed()) return CaptureStatus::kEndOfStream;
    if (!fault_.empty()) return CaptureStatus::kFault;
    const rt::Wakeup::Ticket ticket = wakeup_.ticket();
    if (session_.is_gone() || is_silent()) interrupt();
    if (!session_.is_running()) find_again();
    if (const auto done = session_.next()) {
      if (take(*done, out)) return CaptureStatus::kFrame;
      continue;
    }
    const Deadline now = Clock::now();
    if (now >= deadline) return CaptureStatus::kTimeout;
    const auto left = std::chrono::ceil<milliseconds>(deadline - now);
    wakeup_.wait(ticket, session_.is_running() ? left : std::min(left, kSearchPeriod));
  }
}

bool LibcameraCamera::is_silent() const noexcept {
  if (!session_.is_running()) return false;
  const auto silence = Clock::now() - last_request_;
  return silence > kSilence || (silence > kFirstLook && session_.has_vanished());
}

bool LibcameraCamera::take(const LibcameraSession::Done& done, core::Frame& out) noexcept {
  last_request_ = Clock::now();
  const bool is_filled = fill(done, out);
  if (!is_filled) trouble_.damaged();
  try {
    if (!session_.give_back(done, lock_controls_)) interrupt();
    lock_controls_ = false;
  } catch (...) {  // out of memory
    interrupt();
  }
  return is_filled;
}

bool LibcameraCamera::fill(const LibcameraSession::Done& done, core::Frame& out) noexcept {
  if (out.pixels.size() != static_cast<std::size_t>(info_.width_px) * static_cast<std::size_t>(info_.height_px)) {
    fault_ = "a frame slot of another size than the camera's image";
    return false;
  }
  if (!done.is_whole || session_.read(done, out.pixels.data()) != LumaStatus::kOk) return false;
  out.t_start_ns = clock_.to_monotonic_ns(done.stamp_ns, StampClock::now());
  trouble_.clock(clock_.kind());
  if (info_.readout_ns == 0 && done.readout_ns != 0) info_.readout_ns = done.readout_ns;
  const LiveSequence::Step step = sequence_.next(done.sequence, out.t_start_ns);
  out.sequence = step.sequence;
  out.gap_before = step.gap_before;
  out.exposure_ns = done.exposure_ns > 0 ? done.exposure_ns : info_.exposure_ns;
  out.width_px = info_.width_px;
  out.height_px = info_.height_px;
  trouble_.found();
  return true;
}

void LibcameraCamera::interrupt() noexcept {
  session_.halt();
  session_.close();
  sequence_.interrupted();
  trouble_.lost();
}

void LibcameraCamera::find_again() noexcept {
  try {
    if (session_.run().empty()) {
      lock_controls_ = true;
      last_request_ = Clock::now();
      clock_.forget();
      return;
    }
  } catch (...) {  // out of memory: the next search may succeed
  }
  session_.halt();
  session_.close();
}

void LibcameraCamera::stop() noexcept {
  gate_.shut();
  wakeup_.nudge();
  gate_.wait_until_left();
  session_.halt();
}

}  // namespace drivers
