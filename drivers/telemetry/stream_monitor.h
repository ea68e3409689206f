#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/telemetry/channel_count.h"
#include "drivers/telemetry/layout_watch.h"
#include "drivers/telemetry/sender_watch.h"
#include "drivers/telemetry/topics.h"
#include "hovermodal/closure_report_t.hpp"
#include "hovermodal/displacement_t.hpp"
#include "hovermodal/health_t.hpp"
#include "hovermodal/modal_estimate_t.hpp"
#include "hovermodal/preview_t.hpp"
#include "hovermodal/spectrum_t.hpp"

namespace drivers {

// A listener's knowledge of a run from LCM messages alone: the newest of everything, and losses on the link. It follows
// the first stream_id it receives, and of several runs that send with it one at a time (sender_watch.h). Accepts any
// bytes: undecodable messages are counted and change nothing else, except that a sender of another version is reported.
class StreamMonitor {
 public:
  using Topic = drivers::Topic;
  static constexpr Topic kModal = drivers::kModal, kDisplacement = drivers::kDisplacement,
                         kSpectrum = drivers::kSpectrum, kTracks = drivers::kTracks, kClosure = drivers::kClosure,
                         kHealth = drivers::kHealth, kPreview = drivers::kPreview, kTopics = drivers::kTopics;
  static constexpr std::size_t kHistory = 1024;     // displacement samples kept per channel
  static constexpr std::size_t kMaxChannels = 256;  // surplus channels of a message are ignored
  static constexpr std::size_t kMaxModes = 1024;    // of one estimate, all parts
  static constexpr std::size_t kMaxSpectra = 64;    // channels whose newest spectrum is kept

  explicit StreamMonitor(const std::string& channel_prefix);

  // `now_ns` on any monotonic clock of the caller. Unknown channels are ignored.
  void receive(std::string_view lcm_channel, const void* data, std::size_t n_bytes, std::int64_t now_ns) noexcept;

  [[nodiscard]] const std::string& lcm_channel(Topic topic) const noexcept { return names_[topic]; }
  [[nodiscard]] const ChannelCount& count(Topic topic) const noexcept { return counts_[topic]; }
  // Descriptions of senders of another version; empty: none.
  [[nodiscard]] std::vector<std::string> other_versions() const { return layouts_.words(prefix_); }
  // Descriptions of what is wrong with the senders: of another version, or several with one stream_id; empty: nothing.
  [[nodiscard]] std::vector<std::string> sender_warnings() const;
  [[nodiscard]] const SenderWatch& senders() const noexcept { return senders_; }
  [[nodiscard]] const std::string& stream_id() const noexcept { return stream_id_; }  // empty = nothing received
  [[nodiscard]] std::int64_t config_hash() const noexcept { return config_hash_; }
  [[nodiscard]] std::int64_t stream_time_ns() const noexcept { return stream_time_ns_; }
  [[nodiscard]] std::int64_t last_received_ns() const noexcept { return last_received_ns_; }  // caller's clock

  [[nodiscard]] const std::optional<hovermodal::health_t>& health() const noexcept { return health_; }
  // The previous one of the same run, for rates.
  [[nodiscard]] const std::optional<hovermodal::health_t>& previous_health() const noexcept { return previous_health_; }
  [[nodiscard]] bool is_finished() const noexcept { return is_finished_; }  // a final health message was received
  [[nodiscard]] std::int64_t finished_at_ns() const noexcept { return finished_at_ns_; }

  // The newest estimate: the head of its last received part, and all modes of the parts received so far, in order.
  [[nodiscard]] const std::optional<hovermodal::modal_estimate_t>& estimate() const noexcept { return estimate_; }
  [[nodiscard]] std::vector<const hovermodal::mode_t*> modes() const;
  [[nodiscard]] int parts_heard() const noexcept { return static_cast<int>(parts_.size()); }

  // The newest report of residual diagnosis; and of the comparison of a declared structure with the modes.
  [[nodiscard]] const std::optional<hovermodal::closure_report_t>& closure() const noexcept { return closure_; }
  [[nodiscard]] const std::optional<hovermodal::closure_report_t>& structure() const noexcept { return structure_; }

  // The newest preview image.
  [[nodiscard]] const std::optional<hovermodal::preview_t>& preview() const noexcept { return preview_; }
  // The newest spectrum of each channel; empty if none was received.
  [[nodiscard]] const std::vector<std::optional<hovermodal::spectrum_t>>& spectra() const noexcept { return spectra_; }

  [[nodiscard]] std::size_t n_channels() const noexcept { return history_.size(); }
  [[nodiscard]] std::string channel_name(std::size_t i_channel) const;
  [[nodiscard]] const std::deque<float>& history_mm(std::size_t i_channel) const { return history_[i_channel]; }
  // Stream time of the same samples, and the number of samples ever added to a history.
  [[nodiscard]] const std::deque<std::int64_t>& history_ns() const noexcept { return history_ns_; }
  [[nodiscard]] std::uint64_t n_samples() const noexcept { return n_samples_; }

 private:
  [[nodiscard]] bool follows(std::int64_t run_id, std::int64_t now_ns) noexcept;
  template <class Message>
  std::optional<Message> open(Topic topic, const void* data, std::size_t n_bytes, std::int64_t now_ns);
  void take(hovermodal::modal_estimate_t message);
  void take(const hovermodal::displacement_t& message);
  void take(hovermodal::health_t message, std::int64_t now_ns);
  void take(hovermodal::spectrum_t message);
  void dispatch(Topic topic, const void* data, std::size_t n_bytes, std::int64_t now_ns);

  std::string prefix_;
  LayoutWatch layouts_;
  SenderWatch senders_;
  std::array<std::string, kTopics> names_;
  std::array<ChannelCount, kTopics> counts_{};
  std::string stream_id_;
  bool is_following_ = false;
  std::int64_t config_hash_ = 0, stream_time_ns_ = 0, last_received_ns_ = 0, finished_at_ns_ = 0;
  bool is_finished_ = false;
  std::optional<hovermodal::health_t> health_, previous_health_;
  std::optional<hovermodal::closure_report_t> closure_, structure_;
  std::optional<hovermodal::modal_estimate_t> estimate_;  // its own `modes` moved into parts_
  std::map<std::int16_t, std::vector<hovermodal::mode_t>> parts_;
  std::size_t n_modes_ = 0;
  std::uint64_t n_modal_restarts_ = 0;      // when estimate_ was received
  std::vector<std::deque<float>> history_;  // NaN where not seen
  std::deque<std::int64_t> history_ns_;
  std::uint64_t n_samples_ = 0;
  std::optional<hovermodal::preview_t> preview_;
  std::vector<std::optional<hovermodal::spectrum_t>> spectra_;
};

}  // namespace drivers
