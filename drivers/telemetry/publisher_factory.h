#pragma once

#include <memory>
#include <string>

#include "drivers/telemetry/publisher.h"

namespace drivers {

class EventLog;

struct LcmOptions {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";  // empty = nothing over the network
  std::string channel_prefix =
      "HOVERMODAL";      // <prefix>_MODAL, _DISPLACEMENT, _SPECTRUM, _TRACKS, _CLOSURE, _HEALTH, _PREVIEW
  std::string log_file;  // the same messages into an LCM event log; empty = none
  StreamIdentity identity;
  double max_kbit_s = 0.0;                     // over the network; 0 = no limit (send_budget.h)
  std::shared_ptr<EventLog> record = nullptr;  // a further log: that of the run record
};

// Sends nothing, counts nothing: for runs without telemetry.
class NullPublisher : public Publisher {
 public:
  bool publish(const core::ModalEstimate&, const std::vector<core::ChannelInfo>&) noexcept override { return true; }
  bool publish(const core::DisplacementSample&, const std::vector<core::ChannelInfo>&) noexcept override {
    return true;
  }
  bool publish(const core::TrackFrame&) noexcept override { return true; }
  bool publish(const core::CpsdSums&, const std::vector<core::ChannelInfo>&) noexcept override { return true; }
  bool publish(const core::closure::ClosureReport&) noexcept override { return true; }
  bool publish(const core::Health&) noexcept override { return true; }
  bool publish(const core::Preview&, const std::vector<core::Region>&) noexcept override { return true; }
  [[nodiscard]] std::uint64_t messages_sent() const noexcept override { return 0; }
  [[nodiscard]] std::uint64_t messages_failed() const noexcept override { return 0; }
};

// An LcmPublisher, or a NullPublisher when both the URL and the log file are empty. Throws std::invalid_argument for a
// wrong URL or prefix, std::runtime_error when the network cannot be used, the log cannot be written, or this build
// has no LCM. `warning`, if given, receives a text for the operator if messages leave this computer but cannot be
// received on it; otherwise it is emptied.
[[nodiscard]] std::unique_ptr<Publisher> make_publisher(const LcmOptions& options, std::string* warning = nullptr);

}  // namespace drivers
