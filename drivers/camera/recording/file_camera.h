#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "drivers/camera/camera.h"
#include "drivers/camera/recording/frame_clock.h"
#include "drivers/camera/recording/frame_queue.h"
#include "drivers/camera/recording/frame_source.h"
#include "drivers/camera/stream_pacer.h"

namespace drivers {

struct FileCameraConfig {
  std::string source{};     // video file or folder of images
  double rate_hz = 0.0;     // 0 = from the time stamps or the container
  bool realtime = false;    // deliver frames at the recorded pace; false: as fast as they decode
  double readout_ms = 0.0;  // signed
  core::ReadoutDirection readout_direction = core::ReadoutDirection::kDown;  // in the image as the sensor stored it
  int decoder_mb = kDecoderMb;
  double exposure_ms = 0.0;  // 0 = unknown, or from the telemetry if available
};

// A recording in place of a camera, with the telemetry beside or in it (clip_telemetry.h). The constructor refuses a
// zoom that tracking cannot follow. A separate thread decodes a few frames ahead of `capture`.
// Times are starts of exposure in stream time, from the time stamp file, the container or the frame's number
// (frame_clock.h); a frame's sequence is its cell on the grid of the nominal rate, and jumps where frames are missing.
// Every frame that decodes completely is delivered once, in order, except video frames that repeat the one before.
// An early end (a truncated file) is kEndOfStream with a text in `fault`; kFault comes after the last good frame.
class FileCamera final : public Camera {
 public:
  explicit FileCamera(const FileCameraConfig& config);
  ~FileCamera() override;

  [[nodiscard]] core::CameraInfo info() const override { return info_; }
  void start() override;
  CaptureStatus capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept override;
  void stop() noexcept override;  // any thread; returns when the decoding thread has ended
  [[nodiscard]] std::string fault() const override;
  [[nodiscard]] core::RecordingTimes times() const override;
  [[nodiscard]] DeviceTrouble trouble() const noexcept override;

 private:
  void decode_all();
  void publish(core::Frame& slot);
  void note_trouble() noexcept;
  [[nodiscard]] std::string shortfall(std::uint64_t n_decoded) const;

  std::string path_;
  int decoder_mb_;
  std::uintmax_t n_bytes_ = 0;           // size of the file when it was opened
  std::unique_ptr<FrameSource> source_;  // after start(): used by the decoding thread
  FrameClock clock_;
  std::string telemetry_words_;  // what telemetry is used; empty: none
  bool watches_repeats_ = false;
  std::uint64_t next_sequence_ = 0;  // used by the decoding thread
  // Written by the decoding thread, read by any; relaxed: each counter is independent of other data.
  std::atomic<std::uint64_t> n_damaged_{0}, n_after_damage_{0}, n_repeated_{0};
  core::CameraInfo info_;
  StreamPacer pacer_;
  std::unique_ptr<FrameQueue> queue_;
  std::thread decoder_;
  std::mutex stop_mutex_;  // two threads may stop at the same time; one joins
};

}  // namespace drivers
