#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/telemetry/publisher.h"
#include "drivers/telemetry/publisher_factory.h"
#include "drivers/telemetry/send_budget.h"
#include "drivers/telemetry/topics.h"
#include "hovermodal/spectrum_t.hpp"

namespace drivers {

// Results as LCM messages, over the network, into an LCM event log, or both. Network and log number the messages of an
// LCM channel separately, whether sent or failed: a receiver sees a failed send as a gap. A message withheld from the
// network (LcmOptions::max_kbit_s) has no number there and is no gap; the log contains everything. The spectra of one
// estimate are queued and sent as max_kbit_s permits, until those of the next replace them; at the end all are
// sent. Every health message states how many messages were sent on each channel of its own output, itself included,
// and how many were withheld. Messages above some 1400 bytes are fragmented by LCM.
class LcmPublisher : public Publisher {
 public:
  // Opens and tests all outputs. An output that would lose every message is an error here, not a count later; throws as
  // make_publisher() says. The log file is overwritten.
  explicit LcmPublisher(const LcmOptions& options);
  ~LcmPublisher() override;

  bool publish(const core::ModalEstimate& estimate, const std::vector<core::ChannelInfo>& channels) noexcept override;
  bool publish(const core::DisplacementSample& sample,
               const std::vector<core::ChannelInfo>& channels) noexcept override;
  bool publish(const core::TrackFrame& tracks) noexcept override;
  bool publish(const core::CpsdSums& spectrum, const std::vector<core::ChannelInfo>& channels) noexcept override;
  bool publish(const core::closure::ClosureReport& report) noexcept override;
  bool publish(const core::Health& health) noexcept override;
  bool publish(const core::Preview& preview, const std::vector<core::Region>& regions) noexcept override;

  // A message counts as sent when every open output (network, log) accepted it; a withheld one is neither sent nor
  // failed.
  [[nodiscard]] std::uint64_t messages_sent() const noexcept override {
    return n_sent_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t messages_failed() const noexcept override {
    return n_failed_.load(std::memory_order_relaxed);
  }

  // Not empty: messages are sent, but could not be received on this computer (only possible with ttl >= 1).
  [[nodiscard]] const std::string& warning() const noexcept { return warning_; }

 private:
  // Counters of one output on one LCM channel.
  struct Numbers {
    std::int64_t next_sequence = 0, n_sent = 0;
  };
  using WayNumbers = std::array<Numbers, kTopics>;
  struct Ways;  // the LCM instance and the event logs

  template <class Message>
  bool send(Topic topic, Message& message);
  template <class Message>
  void encode(Topic topic, Message& message, const WayNumbers& numbers);
  template <class Message>
  bool send_over_network(Topic topic, Message& message);
  template <class Message>
  bool write_to_log(Topic topic, Message& message);
  [[nodiscard]] bool may_send(Topic topic, int n_bytes);
  void send_waiting_spectra(bool whatever_the_budget);
  template <class Messages>
  bool send_all(Topic topic, Messages& messages);
  template <class Body>
  bool guarded(Body&& body) noexcept;
  void remember(const std::vector<core::ChannelInfo>& channels);

  StreamIdentity identity_;
  std::unique_ptr<Ways> ways_;
  std::array<std::string, kTopics> channel_names_;
  WayNumbers network_numbers_{}, log_numbers_{};
  std::array<std::int64_t, kTopics> n_held_back_{};
  SendBudget budget_;
  std::deque<hovermodal::spectrum_t> waiting_spectra_;  // of one snapshot at most
  std::vector<core::ChannelInfo> channel_infos_;        // as last published: health carries them
  std::vector<std::uint8_t> buffer_;                    // encoded message, reused
  std::string warning_;
  std::atomic<std::uint64_t> n_sent_{0}, n_failed_{0};  // relaxed: independent of other data
};

}  // namespace drivers
