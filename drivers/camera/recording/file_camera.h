#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "drivers/camera/camera.h"
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
  double exposure_ms = 0.0;                                                  // 0 = unknown
};

// A recording in place of a camera. A thread of its own decodes into a few frames ahead of `capture`.
// Times are starts of exposure in stream time: those of the time stamp file where there is one (timestamp_file.h), else
// frame number / rate. A container's rate is believed only within 1e-3 .. 1e6 Hz and where config.rate_hz is 0.
// Nothing is ever skipped: every frame that decodes is delivered once, in order.
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

 private:
  void take_times(const FileCameraConfig& config);
  void decode_all();
  [[nodiscard]] std::int64_t frame_time_ns(std::uint64_t frame) const noexcept;
  [[nodiscard]] std::string shortfall(std::uint64_t n_decoded) const;

  std::string path_;
  std::unique_ptr<FrameSource> source_;  // after start(): the decoding thread's
  std::string stamp_file_;               // empty: none
  std::vector<std::int64_t> stamps_ns_;
  core::CameraInfo info_;
  StreamPacer pacer_;
  std::unique_ptr<FrameQueue> queue_;
  std::thread decoder_;
  std::mutex stop_mutex_;  // two threads may stop at once; one joins
};

}  // namespace drivers
