#include "drivers/telemetry/run_record_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>

#include "drivers/storage/text_file.h"
#include "drivers/telemetry/decode.h"
#include "drivers/telemetry/encode_flight.h"
#include "drivers/telemetry/encode_run.h"
#include "drivers/telemetry/event_log_format.h"
#include "drivers/telemetry/event_log_reader.h"
#include "drivers/telemetry/record_folder.h"
#include "drivers/telemetry/topics.h"
#include "hovermodal/health_t.hpp"

namespace drivers {

class RunRecordReader::Impl {
 public:
  explicit Impl(const std::string& path) : files(files_from(path)) {
    for (const std::string& file : files) {
      std::error_code unknown;
      const std::uintmax_t size = std::filesystem::file_size(file, unknown);
      if (!unknown) n_bytes += size;
    }
    while (!head_) {
      if (!next_event()) {
        throw FileError(fmt::format(
            "{}: holds no recorded run: give a file that record.directory holds (a log of messages alone, as "
            "telemetry.log_file makes, lacks the points)",
            path));
      }
      take_head();
    }
  }

  [[nodiscard]] bool next(core::RecordedFrame& out) {
    if (out.tracks.points.size() != head_->keyframe.points.size()) out.tracks = head_->keyframe;
    aircraft = {};
    while (next_event()) {
      const std::string_view channel = event_.channel;
      if (channel.ends_with(kTopicSuffixes[kHealth])) hear();
      if (channel.ends_with(kRunAircraftSuffix)) hear_aircraft();
      if (channel.ends_with(kRunRecordingSuffix)) hear_times();
      const bool is_frame = (channel.ends_with(kRunFrameSuffix) && take<hovermodal::run_frame_t>(out)) ||
                            (channel.ends_with(kRunThinnedFrameSuffix) && take<hovermodal::run_thinned_frame_t>(out));
      if (!is_frame) continue;
      n_left_out += out.attitude.n_left_out;
      return true;
    }
    return false;
  }

  std::vector<std::string> files;
  std::optional<core::RunHead> head_;
  std::uint64_t n_damaged = 0, n_left_out = 0, n_bytes = 0, n_bytes_read = 0;
  bool starts_late = false;
  std::string end;
  std::optional<core::RunCounts> counts;
  core::RecordingTimes times;
  core::AircraftBatch aircraft;

 private:
  template <class Message>
  std::optional<Message> decode() {
    auto message = decode_message<Message>(event_.data.data(), event_.data.size());
    if (!message) ++n_damaged;
    return message;
  }

  template <class Message>
  [[nodiscard]] bool take(core::RecordedFrame& out) {
    const auto message = decode<Message>();
    const bool is_taken = message && take_frame(*message, out);
    if (message && !is_taken) ++n_damaged;  // messages that did not decode are already counted
    return is_taken;
  }

  // Reads into event_; false: the end of the last file.
  [[nodiscard]] bool next_event() {
    for (;;) {
      if (!log_) {
        if (n_opened_ == files.size()) return false;
        log_.emplace(files[n_opened_++]);
      }
      const std::uint64_t n_before = log_->n_damaged();
      const bool is_there = log_->next(event_);
      n_damaged += log_->n_damaged() - n_before;
      if (is_there) {
        n_bytes_read += kEventHeadBytes + event_.channel.size() + event_.data.size();
        return true;
      }
      log_.reset();
    }
  }

  void take_head() {
    const std::string_view channel = event_.channel;
    if (channel.ends_with(kRunFileSuffix)) {
      if (const auto piece = decode<hovermodal::run_file_t>()) take_piece(*piece);
    } else if (channel.ends_with(kRunSuffix)) {
      const auto message = decode<hovermodal::run_t>();
      if (!message) return;
      head_ = from_message(*message);
      if (!head_) {
        ++n_damaged;
        return;
      }
      starts_late = message->file_number != 0;
      head_->files = std::move(pieces_);
    }
  }

  // Pieces come in order, before the head.
  void take_piece(const hovermodal::run_file_t& piece) {
    if (pieces_.empty() || pieces_.back().key != piece.key) pieces_.push_back({piece.key, piece.name, {}});
    std::string& bytes = pieces_.back().bytes;
    const bool fits = piece.offset == static_cast<std::int64_t>(bytes.size()) &&
                      bytes.size() + piece.bytes.size() <= core::NamedFile::kMostBytes;
    if (fits) {
      bytes.append(piece.bytes.begin(), piece.bytes.end());
    } else {
      ++n_damaged;
    }
  }

  void hear() {
    const auto health = decode<hovermodal::health_t>();
    if (!health) return;
    if (health->state != "finished" && !health->state.starts_with("fault")) return;
    end = health->state;
    const auto count = [](std::int64_t n) { return static_cast<std::uint64_t>(std::max<std::int64_t>(0, n)); };
    counts = {count(health->frames_in), count(health->frames_processed), count(health->frames_dropped),
              count(health->frames_missing), count(health->snapshots_skipped)};
  }

  void hear_aircraft() {
    const auto message = decode<hovermodal::aircraft_t>();
    if (!message) return;
    core::AircraftState state;
    const bool has_room = aircraft.n < core::AircraftBatch::kMost;
    if (has_room && take_sample(*message, state)) {
      aircraft.states[aircraft.n++] = state;
    } else {
      ++n_damaged;
    }
  }

  void hear_times() {
    const auto message = decode<hovermodal::run_recording_t>();
    if (!message) return;
    if (auto heard = from_message(*message)) {
      times = std::move(*heard);
    } else {
      ++n_damaged;
    }
  }

  std::optional<EventLogReader> log_;
  EventLogReader::Event event_;
  std::size_t n_opened_ = 0;
  std::vector<core::NamedFile> pieces_;
};

RunRecordReader::RunRecordReader(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
RunRecordReader::~RunRecordReader() = default;
const core::RunHead& RunRecordReader::head() const noexcept { return *impl_->head_; }
bool RunRecordReader::next(core::RecordedFrame& out) { return impl_->next(out); }
const std::vector<std::string>& RunRecordReader::files() const noexcept { return impl_->files; }
std::uint64_t RunRecordReader::bytes() const noexcept { return impl_->n_bytes; }
std::uint64_t RunRecordReader::bytes_read() const noexcept { return impl_->n_bytes_read; }
std::uint64_t RunRecordReader::n_damaged() const noexcept { return impl_->n_damaged; }
std::uint64_t RunRecordReader::n_attitudes_left_out() const noexcept { return impl_->n_left_out; }
bool RunRecordReader::starts_late() const noexcept { return impl_->starts_late; }
const std::string& RunRecordReader::end() const noexcept { return impl_->end; }
const std::optional<core::RunCounts>& RunRecordReader::counts() const noexcept { return impl_->counts; }
const core::AircraftBatch& RunRecordReader::aircraft() const noexcept { return impl_->aircraft; }
const core::RecordingTimes& RunRecordReader::times() const noexcept { return impl_->times; }

}  // namespace drivers
