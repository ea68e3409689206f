#include "drivers/telemetry/run_recorder.h"

#include <fmt/format.h>

#include <atomic>
#include <cstring>
#include <vector>

#include "drivers/telemetry/encode_flight.h"
#include "drivers/telemetry/encode_run.h"
#include "drivers/telemetry/rotating_log.h"
#include "rt/clock.h"

namespace drivers {
namespace {

template <class Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

class LcmRunRecorder : public RunRecorder {
 public:
  explicit LcmRunRecorder(const RecordOptions& options)
      : prefix_(options.channel_prefix),
        frame_channel_(options.channel_prefix + kRunFrameSuffix),
        thinned_channel_(options.channel_prefix + kRunThinnedFrameSuffix),
        aircraft_channel_(options.channel_prefix + kRunAircraftSuffix),
        identity_(options.identity),
        log_(std::make_shared<RotatingLog>(options)) {}

  void begin(const core::RunHead& head) override {
    log_->begin([this, message = to_message(head, identity_), files = head.files](EventLog& file, int number) {
      return write_head(file, message, files, number);
    });
  }

  bool add(const core::TrackFrame& tracks, const core::AttitudeBatch& attitude,
           std::uint32_t stride) noexcept override {
    try {
      return write(to_message(tracks, attitude), stride);
    } catch (...) {  // out of memory: the frame is lost
      n_lost_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
  }

  bool add(const core::AircraftBatch& aircraft) noexcept override {
    bool all = true;
    for (std::size_t i = 0; i < aircraft.n; ++i) {
      try {
        all = log_->write(aircraft_channel_, encoded(to_message(aircraft.states[i])), rt::utc_ns()) && all;
      } catch (...) {  // out of memory
        n_lost_.fetch_add(1, std::memory_order_relaxed);
        all = false;
      }
    }
    return all;
  }

  bool end(const core::RecordingTimes& times) noexcept override {
    try {
      return log_->write(prefix_ + kRunRecordingSuffix, encoded(to_message(times)), rt::utc_ns());
    } catch (...) {  // no memory
      n_lost_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
  }

  bool close() noexcept override {
    if (log_->close()) return true;
    is_unsafe_.store(true, std::memory_order_relaxed);
    return false;
  }

  [[nodiscard]] std::uint64_t n_lost() const noexcept override {
    return n_lost_.load(std::memory_order_relaxed) + log_->n_lost();
  }
  [[nodiscard]] std::string failure() const override {
    const std::uint64_t n = n_lost();
    if (n == 0 && !is_unsafe_.load(std::memory_order_relaxed)) return {};
    const int error = log_->error();
    const std::string why = error != 0 ? std::strerror(error) : "record.quota_mb is reached, or memory ran out";
    if (n == 0) return fmt::format("the end of the run record may be lost: {}: {}; check the disk", path(), why);
    return fmt::format(
        "{} frames and messages are missing in the run record, and a replay lacks them: {}: {}; free space on that "
        "disk, or lower record.quota_mb",
        n, path(), why);
  }
  [[nodiscard]] std::string path() const override { return log_->path(); }
  [[nodiscard]] std::shared_ptr<EventLog> log() override { return log_; }

 private:
  [[nodiscard]] bool write(const hovermodal::run_frame_t& frame, std::uint32_t stride) {
    if (stride == 1) return log_->write(frame_channel_, encoded(frame), rt::utc_ns());
    const hovermodal::run_thinned_frame_t thinned{static_cast<std::int32_t>(stride), frame};
    return log_->write(thinned_channel_, encoded(thinned), rt::utc_ns());
  }
  [[nodiscard]] bool write_head(EventLog& file, hovermodal::run_t message, const std::vector<core::NamedFile>& files,
                                int number) const {
    const std::int64_t now_ns = rt::utc_ns();
    for (const core::NamedFile& named : files) {
      for (const auto& piece : to_messages(named)) {
        if (!file.write(prefix_ + kRunFileSuffix, encoded(piece), now_ns)) return false;
      }
    }
    message.file_number = number;
    message.utc_ns = now_ns;
    return file.write(prefix_ + kRunSuffix, encoded(message), now_ns);
  }

  std::string prefix_, frame_channel_, thinned_channel_, aircraft_channel_;
  StreamIdentity identity_;
  std::shared_ptr<RotatingLog> log_;
  // Relaxed: independent of other data.
  std::atomic<std::uint64_t> n_lost_{0};  // not encoded, for lack of memory
  std::atomic<bool> is_unsafe_{false};
};

}  // namespace

std::unique_ptr<RunRecorder> make_run_recorder(const RecordOptions& options) {
  return std::make_unique<LcmRunRecorder>(options);
}

}  // namespace drivers
