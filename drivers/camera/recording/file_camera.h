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
  bool realtime = false;    // hand frames out at the pace they were taken, else as fast as they decode
  double readout_ms = 0.0;  // signed
  core::ReadoutDirection readout_direction = core::ReadoutDirection::kDown;  // in the image as the sensor stored it
  double exposure_ms = 0.0;  // 0 = unknown: that of the telemetry, where there is any
};

// A recording in place of a camera, with what the camera wrote of itself beside or in it (clip_telemetry.h). A zoom that
// tracking cannot follow is refused by the constructor. A thread of its own decodes into a few frames ahead of `capture`.
// Times are starts of exposure in stream time, of the time stamp file, the container or the frame's number
// (frame_clock.h); a frame's sequence is its cell on the grid of the nominal rate, and jumps where frames are missing.
// Every frame that decodes whole is delivered once, in order, except those of a video that repeat the one before.
// An early end (a truncated file) is kEndOfStream with a text in `fault`; kFault follows the last good frame.
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
  std::uintmax_t n_bytes_ = 0;  // of the file when it was opened
  std::unique_ptr<FrameSource> source_;  // after start(): the decoding thread's
  FrameClock clock_;
  std::string telemetry_words_;  // what was taken from telemetry; empty: there is none
  bool watches_repeats_ = false;
  std::uint64_t next_sequence_ = 0;  // the decoding thread's
  // Written by the decoding thread, read by any; relaxed: counts on their own.
  std::atomic<std::uint64_t> n_damaged_{0}, n_after_damage_{0}, n_repeated_{0};
  core::CameraInfo info_;
  StreamPacer pacer_;
  std::unique_ptr<FrameQueue> queue_;
  std::thread decoder_;
  std::mutex stop_mutex_;  // two threads may stop at once; one joins
};

}  // namespace drivers
