#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "drivers/camera/camera.h"
#include "drivers/camera/camera_kind.h"
#include "drivers/camera/device/capture_gate.h"
#include "drivers/camera/device/live_sequence.h"
#include "drivers/camera/device/trouble_count.h"
#include "drivers/camera/network/sender_clock.h"
#include "drivers/camera/network/stream_address.h"
#include "drivers/camera/network/stream_link.h"
#include "drivers/camera/recording/picture_luma.h"
#include "rt/spsc_ring.h"
#include "rt/wakeup.h"

namespace drivers {

struct StreamCameraConfig {
  std::string source{};  // stream_address.h
  StreamTransport transport = StreamTransport::kTcp;
  double rate_hz = 0.0;     // 0 = as the sender states or, where its times contradict that, as they show
  double readout_ms = 0.0;  // signed
  core::ReadoutDirection readout_direction = core::ReadoutDirection::kDown;
  double exposure_ms = 0.0;  // 0 = unknown
  int decoder_mb = kDecoderMb;
};

// A camera behind a network, which sends compressed video. A thread of its own receives and decodes into a ring, from
// which `capture` copies without a lock or allocation; where the ring is full, the newest picture is lost.
// Times: the sender's (sender_clock.h); the stamp is later than the start of exposure by encoding and transmission,
// which no stream states. The first second of every connection is not delivered.
// Numbers: by the sender's times, since streams number no frames; where pictures are missing they jump.
// Losses: pictures that do not decode completely are left out, counted as damaged, and with them all that were
// predicted from them, up to the next key frame; likewise after a gap, where lost packets are not sent again.
// Faults: a sender that ends or is silent is called again until it answers; meanwhile `capture` gives kTimeout and
// `trouble` reports the loss. Another size or pixel format than at first is kFault.
class StreamCamera final : public Camera {
 public:
  // Connects, to learn size and rate, and ends the connection. Throws DeviceMissing: no video from there.
  explicit StreamCamera(const StreamCameraConfig& config);
  ~StreamCamera() override;

  [[nodiscard]] core::CameraInfo info() const override { return info_; }
  void start() override;
  CaptureStatus capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept override;
  void stop() noexcept override;  // any thread; returns when the receiving thread has ended
  [[nodiscard]] std::string fault() const override;
  [[nodiscard]] DeviceTrouble trouble() const noexcept override { return trouble_.read(); }

 private:
  void describe(StreamLink& link, const StreamCameraConfig& config);
  void receive_all() noexcept;
  void receive(StreamLink& link);
  void take(const StreamLink& link);
  [[nodiscard]] bool follows_a_loss(const StreamLink& link, std::int64_t arrived_ns) noexcept;
  void publish(const AVFrame& picture, std::int64_t t_ns) noexcept;
  void wait_for_the_next_call() noexcept;

  StreamAddress address_;
  int decoder_mb_;
  core::CameraInfo info_;
  bool has_times_ = false;           // the sender states when it sent each picture
  std::optional<PictureLuma> luma_;  // the receiving thread's, like the next five
  SenderClock clock_;
  LiveSequence sequence_{1.0};
  std::optional<std::int64_t> last_sent_ns_;
  std::optional<std::int64_t> damaged_at_ns_;  // arrival, since when no key frame has come
  bool delivers_ = false;                      // this connection, after its first second
  std::unique_ptr<rt::SpscRing<core::Frame>> ring_;
  rt::Wakeup arrived_, called_off_;  // a picture, for `capture`; the end, for the receiving thread
  std::atomic<bool> is_stopped_{false};
  CaptureGate gate_;
  TroubleCount trouble_;
  // Faults: one thread writes the text, then sets the flag (release); readers load the flag first (acquire).
  std::string changed_, wrong_slot_;
  std::atomic<bool> has_changed_{false}, has_wrong_slot_{false};
  std::thread receiver_;
  std::mutex stop_mutex_;  // two threads may stop at the same time; one joins
};

}  // namespace drivers
