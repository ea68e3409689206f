#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/telemetry/publisher.h"
#include "drivers/telemetry/publisher_factory.h"
#include "drivers/telemetry/topics.h"

namespace drivers {

// Results as LCM messages, over the network, into an LCM event log, or both. Each LCM channel has a sequence of its own
// that grows with every message, sent or not: a receiver sees a failed send as a gap. Every health message says how
// many were sent on each channel, itself included. Messages above some 1400 bytes are fragmented by LCM.
class LcmPublisher : public Publisher {
 public:
  // Opens and tests everything. A way that loses every message is an error here, not a count later; throws as
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

  // A message counts as sent when every way open (network, log) took it.
  [[nodiscard]] std::uint64_t messages_sent() const noexcept override;
  [[nodiscard]] std::uint64_t messages_failed() const noexcept override {
    return n_failed_.load(std::memory_order_relaxed);
  }

  // Not empty: messages leave, but could not be heard on this computer (only possible with ttl >= 1).
  [[nodiscard]] const std::string& warning() const noexcept { return warning_; }

 private:
  struct Channel {
    std::string name;
    std::int64_t next_sequence = 0;
    std::atomic<std::int64_t> n_sent{0};  // relaxed: a count on its own
  };
  struct Ways;  // the LCM instance and the event log

  template <class Message>
  bool send(Topic topic, Message& message);
  template <class Messages>
  bool send_all(Topic topic, Messages& messages);
  template <class Body>
  bool guarded(Body&& body) noexcept;
  void remember(const std::vector<core::ChannelInfo>& channels);

  StreamIdentity identity_;
  std::unique_ptr<Ways> ways_;
  std::array<Channel, kTopics> channels_;
  std::vector<core::ChannelInfo> channel_infos_;  // as last published: health carries them
  std::vector<std::uint8_t> buffer_;              // encoded message, reused
  std::string warning_;
  std::atomic<std::uint64_t> n_failed_{0};
};

}  // namespace drivers
