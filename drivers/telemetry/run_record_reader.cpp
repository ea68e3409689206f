#include "drivers/telemetry/run_record_reader.h"

#include <fmt/format.h>
#include <lcm/eventlog.h>

#include <cstdio>
#include <optional>
#include <string_view>

#include "drivers/storage/text_file.h"
#include "drivers/telemetry/decode.h"
#include "drivers/telemetry/encode_run.h"
#include "drivers/telemetry/record_folder.h"
#include "drivers/telemetry/topics.h"
#include "hovermodal/health_t.hpp"

namespace drivers {
namespace {

using Log = std::unique_ptr<lcm_eventlog_t, decltype(&lcm_eventlog_destroy)>;
using Event = std::unique_ptr<lcm_eventlog_event_t, decltype(&lcm_eventlog_free_event)>;

}  // namespace

class RunRecordReader::Impl {
 public:
  explicit Impl(const std::string& path) : files(files_from(path)) {
    while (!head_) {
      const Event event = next_event();
      if (!event) {
        throw FileError(fmt::format(
            "{}: holds no recorded run: give a file that record.directory holds (a log of messages alone, as "
            "telemetry.log_file makes, lacks the points)",
            path));
      }
      take_head(*event);
    }
  }

  [[nodiscard]] bool next(core::RecordedFrame& out) {
    if (out.tracks.points.size() != head_->keyframe.points.size()) out.tracks = head_->keyframe;
    while (const Event event = next_event()) {
      const std::string_view channel = channel_of(*event);
      if (channel.ends_with(kTopicSuffixes[kHealth])) hear(*event);
      if (!channel.ends_with(kRunFrameSuffix)) continue;
      const auto message = decode<hovermodal::run_frame_t>(*event);
      if (message && take_frame(*message, out)) {
        n_left_out += out.attitude.n_left_out;
        return true;
      }
      if (message) ++n_damaged;  // one that did not decode is counted already
    }
    return false;
  }

  std::vector<std::string> files;
  std::optional<core::RunHead> head_;
  std::uint64_t n_damaged = 0, n_left_out = 0;
  bool starts_late = false, was_thinned = false;
  std::string end;

 private:
  static std::string_view channel_of(const lcm_eventlog_event_t& event) {
    return {event.channel, static_cast<std::size_t>(event.channellen)};
  }
  template <class Message>
  std::optional<Message> decode(const lcm_eventlog_event_t& event) {
    auto message = decode_message<Message>(event.data, static_cast<std::size_t>(event.datalen));
    if (!message) ++n_damaged;
    return message;
  }

  [[nodiscard]] Event next_event() {
    for (;;) {
      if (!log_) {
        if (n_opened_ == files.size()) return {nullptr, &lcm_eventlog_free_event};
        const std::string& path = files[n_opened_++];
        log_.reset(lcm_eventlog_create(path.c_str(), "r"));
        if (!log_) throw FileError(path + ": cannot be read: is it there, and readable?");
      }
      if (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log_.get()))
        return {event, &lcm_eventlog_free_event};
      if (std::feof(log_->f) == 0 && std::ferror(log_->f) == 0) {  // lengths that cannot be: on to the next event
        ++n_damaged;
        continue;
      }
      log_.reset();
    }
  }

  void take_head(const lcm_eventlog_event_t& event) {
    const std::string_view channel = channel_of(event);
    if (channel.ends_with(kRunFileSuffix)) {
      if (const auto piece = decode<hovermodal::run_file_t>(event)) take_piece(*piece);
    } else if (channel.ends_with(kRunSuffix)) {
      const auto message = decode<hovermodal::run_t>(event);
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

  // Pieces come in order, in front of the head.
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

  void hear(const lcm_eventlog_event_t& event) {
    const auto health = decode<hovermodal::health_t>(event);
    if (!health) return;
    was_thinned = was_thinned || health->rate_hz < 0.75 * head_->camera.rate_hz;
    if (health->state == "finished" || health->state.starts_with("fault")) end = health->state;
  }

  Log log_{nullptr, &lcm_eventlog_destroy};
  std::size_t n_opened_ = 0;
  std::vector<core::NamedFile> pieces_;
};

RunRecordReader::RunRecordReader(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
RunRecordReader::~RunRecordReader() = default;
const core::RunHead& RunRecordReader::head() const noexcept { return *impl_->head_; }
bool RunRecordReader::next(core::RecordedFrame& out) { return impl_->next(out); }
const std::vector<std::string>& RunRecordReader::files() const noexcept { return impl_->files; }
std::uint64_t RunRecordReader::n_damaged() const noexcept { return impl_->n_damaged; }
std::uint64_t RunRecordReader::n_attitudes_left_out() const noexcept { return impl_->n_left_out; }
bool RunRecordReader::starts_late() const noexcept { return impl_->starts_late; }
bool RunRecordReader::was_thinned() const noexcept { return impl_->was_thinned; }
const std::string& RunRecordReader::end() const noexcept { return impl_->end; }

}  // namespace drivers
