#include "drivers/camera/network/stream_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "drivers/camera/device_missing.h"
#include "drivers/camera/frame_copy.h"
#include "drivers/camera/line_timing.h"
#include "drivers/camera/recording/frame_clock.h"
#include "drivers/camera/recording/frame_source.h"
#include "drivers/camera/recording/libav_versions.h"
#include "drivers/camera/stream_pacer.h"

namespace drivers {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kPatience{10'000};  // for a connection with its first key frame
constexpr milliseconds kSilence{3000};     // after so long without a picture the sender is called again
constexpr double kSilentPeriods = 10.0;    // and after at least so many frame periods
constexpr milliseconds kCallPeriod{500};
constexpr std::size_t kRingSlots = 8;           // evens out bursts: packets of one key frame delay those behind it
constexpr std::size_t kMeasuredIntervals = 15;  // for the frame rate
constexpr double kRateError = 0.05;             // a stated rate that the times contradict by more is not used
constexpr double kGapPeriods = 1.5;             // between two pictures, without one missing
constexpr std::int64_t kRefresh_ns = 10'000'000'000;  // a sender without key frames renews its picture within this time

std::int64_t now_ns() noexcept { return Clock::now().time_since_epoch().count(); }  // CLOCK_MONOTONIC

double median_rate_hz(std::vector<std::int64_t> sent_ns) {
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < sent_ns.size(); ++i) intervals.push_back(sent_ns[i] - sent_ns[i - 1]);
  if (intervals.empty()) return 0.0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle > 0 ? 1e9 / static_cast<double>(*middle) : 0.0;
}

}  // namespace

StreamCamera::StreamCamera(const StreamCameraConfig& config)
    : address_(stream_address(config.source, config.transport)), decoder_mb_(config.decoder_mb) {
  const LineTiming timing = checked_line_timing(config.readout_ms, config.exposure_ms);
  info_.readout_ns = timing.readout_ns;
  info_.readout_direction = config.readout_direction;
  info_.exposure_ns = timing.exposure_ns;
  try {
    StreamLink link(address_, decoder_mb_, kPatience, is_stopped_);
    describe(link, config);
  } catch (const std::runtime_error& error) {
    throw DeviceMissing(
        fmt::format("{}; is the camera on, and the address right? Try: ffplay {}", error.what(), address_.shown));
  }
}

StreamCamera::~StreamCamera() { stop(); }

void StreamCamera::describe(StreamLink& link, const StreamCameraConfig& config) {
  std::vector<std::int64_t> sent_ns;
  for (std::size_t n_pictures = 0; n_pictures <= kMeasuredIntervals + 1; ++n_pictures) {  // the first may have no time
    const DecodeStatus status = link.next(kPatience);
    if (status == DecodeStatus::kEnd) break;
    if (status == DecodeStatus::kDamaged) continue;
    if (!luma_) {
      const std::string unwanted = PictureLuma::unwanted(static_cast<AVPixelFormat>(link.picture().format));
      if (!unwanted.empty()) throw std::runtime_error(fmt::format("{}: video has {}", address_.shown, unwanted));
      luma_.emplace(link.picture());
      info_.width_px = link.picture().width, info_.height_px = link.picture().height;
    }
    if (const auto sent = link.sent_ns()) sent_ns.push_back(*sent);
  }
  has_times_ = sent_ns.size() > 1;
  if (!luma_) throw std::runtime_error(fmt::format("{}: not one picture decodes", address_.shown));
  require_usable_size(address_.shown, info_.width_px, info_.height_px);
  const auto stated = link.container().stated_rates_hz();
  const double measured_hz = median_rate_hz(std::move(sent_ns));
  const auto fits = [&](double rate_hz) { return std::abs(rate_hz - measured_hz) <= kRateError * measured_hz; };
  const auto found = std::find_if(stated.begin(), stated.end(), fits);
  info_.rate_hz = config.rate_hz > 0.0 ? config.rate_hz : found != stated.end() ? *found : measured_hz;
  if (!is_usable_rate(info_.rate_hz)) {
    throw std::runtime_error(
        fmt::format("{}: neither states a frame rate nor times its pictures: set camera.rate_hz", address_.shown));
  }
  info_.coding_block_px = link.container().coding_block_px();
  info_.description = fmt::format("stream {} ({}, {} x {} px), {:.6g} Hz{}", address_.shown,
                                  link.container().codec_name(), info_.width_px, info_.height_px, info_.rate_hz,
                                  config.rate_hz > 0.0 || found != stated.end() ? "" : " as its times show");
}

void StreamCamera::start() {
  if (receiver_.joinable()) throw std::runtime_error(fmt::format("{}: started twice without a stop", address_.shown));
  core::Frame prototype;
  prototype.width_px = info_.width_px, prototype.height_px = info_.height_px;
  prototype.pixels.resize(static_cast<std::size_t>(info_.width_px) * static_cast<std::size_t>(info_.height_px));
  ring_ = std::make_unique<rt::SpscRing<core::Frame>>(kRingSlots, prototype);
  ring_->set_reader_wakeup(&arrived_);
  sequence_ = LiveSequence(info_.rate_hz);
  has_changed_.store(false), has_wrong_slot_.store(false);
  is_stopped_.store(false);
  gate_.open();
  receiver_ = std::thread([this] { receive_all(); });
}

void StreamCamera::receive_all() noexcept {
  while (!is_stopped_.load() && !has_changed_.load()) {
    try {
      StreamLink link(address_, decoder_mb_, kPatience, is_stopped_);
      receive(link);
    } catch (const std::exception&) {  // no answer, or out of memory: the next call may succeed
    }
    if (is_stopped_.load()) return;
    sequence_.interrupted();
    trouble_.lost();
    wait_for_the_next_call();
  }
}

void StreamCamera::wait_for_the_next_call() noexcept {
  const rt::Wakeup::Ticket ticket = called_off_.ticket();
  if (!is_stopped_.load()) called_off_.wait(ticket, kCallPeriod);
}

void StreamCamera::receive(StreamLink& link) {
  clock_.forget();
  last_sent_ns_.reset(), damaged_at_ns_.reset(), delivers_ = false;
  const auto silence = std::max(kSilence, milliseconds(std::llround(1e3 * kSilentPeriods / info_.rate_hz)));
  while (!has_changed_.load()) {
    switch (link.next(silence)) {
      case DecodeStatus::kEnd:
        return;
      case DecodeStatus::kDamaged:
        if (delivers_ && !is_stopped_.load()) trouble_.damaged();
        if (link.is_predicted()) damaged_at_ns_ = now_ns();
        break;
      case DecodeStatus::kPicture:
        take(link);
    }
  }
}

void StreamCamera::take(const StreamLink& link) {
  const AVFrame& picture = link.picture();
  if (picture.width != info_.width_px || picture.height != info_.height_px || !luma_->fits(picture)) {
    changed_ = fmt::format("{}: sends {} x {} px of another kind than at first ({} x {} px): start the service again",
                           address_.shown, picture.width, picture.height, info_.width_px, info_.height_px);
    has_changed_.store(true, std::memory_order_release);
    return arrived_.nudge();
  }
  const std::int64_t arrived_ns = now_ns();
  if (has_times_ && !link.sent_ns()) return delivers_ ? trouble_.damaged() : void();
  const bool is_damaged = follows_a_loss(link, arrived_ns);
  const auto t_ns = clock_.to_monotonic_ns(link.sent_ns(), arrived_ns);
  trouble_.clock(has_times_ ? StampClock::Kind::kMonotonic : StampClock::Kind::kArrival);
  if (!t_ns) return sequence_.interrupted();
  delivers_ = true;
  if (is_damaged) return trouble_.damaged();
  publish(picture, *t_ns);
}

// Whether the picture may hold parts of one that was lost.
bool StreamCamera::follows_a_loss(const StreamLink& link, std::int64_t arrived_ns) noexcept {
  const auto sent_ns = link.sent_ns();
  if (address_.may_lose && link.is_predicted() && sent_ns && last_sent_ns_) {
    const double periods = static_cast<double>(*sent_ns - *last_sent_ns_) * 1e-9 * info_.rate_hz;
    if (periods > kGapPeriods) damaged_at_ns_ = arrived_ns;
  }
  last_sent_ns_ = sent_ns;
  if (is_key_frame(link.picture())) damaged_at_ns_.reset();
  if (damaged_at_ns_ && arrived_ns - *damaged_at_ns_ > kRefresh_ns) damaged_at_ns_.reset();
  return damaged_at_ns_.has_value();
}

void StreamCamera::publish(const AVFrame& picture, std::int64_t t_ns) noexcept {
  auto writer = ring_->writer();
  core::Frame* slot = writer.try_claim();
  if (slot == nullptr) return;  // the numbers jump
  luma_->read(picture, slot->pixels.data());
  const LiveSequence::Step step = sequence_.next(0, t_ns);  // no numbers: by the time
  slot->sequence = step.sequence, slot->gap_before = step.gap_before;
  slot->t_start_ns = t_ns, slot->exposure_ns = info_.exposure_ns;
  writer.publish();
  trouble_.found();
}

CaptureStatus StreamCamera::capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept {
  const CaptureGate::Pass pass(gate_);
  const Clock::time_point deadline = deadline_after(timeout);
  for (;;) {
    if (gate_.is_closed()) return CaptureStatus::kEndOfStream;
    const rt::Wakeup::Ticket ticket = arrived_.ticket();
    if (has_wrong_slot_.load(std::memory_order_relaxed)) return CaptureStatus::kFault;
    auto reader = ring_->reader();
    if (const core::Frame* frame = reader.front(); frame != nullptr) {
      if (!copy_frame(*frame, out)) {
        wrong_slot_ = "a frame slot of another size than the camera's image";
        has_wrong_slot_.store(true, std::memory_order_release);
        continue;
      }
      reader.pop();
      return CaptureStatus::kFrame;
    }
    if (has_changed_.load(std::memory_order_acquire)) return CaptureStatus::kFault;
    const Clock::time_point now = Clock::now();
    if (now >= deadline) return CaptureStatus::kTimeout;
    arrived_.wait(ticket, std::chrono::ceil<milliseconds>(deadline - now));
  }
}

void StreamCamera::stop() noexcept {
  gate_.shut();
  arrived_.nudge();
  gate_.wait_until_left();
  is_stopped_.store(true);
  called_off_.nudge();
  const std::lock_guard lock(stop_mutex_);
  if (receiver_.joinable()) receiver_.join();
}

std::string StreamCamera::fault() const {
  if (has_wrong_slot_.load(std::memory_order_acquire)) return wrong_slot_;
  return has_changed_.load(std::memory_order_acquire) ? changed_ : std::string();
}

}  // namespace drivers
