#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/types/closure_report.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "core/types/preview.h"
#include "core/types/region.h"
#include "core/types/track.h"

namespace drivers {

// Origin of a run's messages, contained in every message.
struct StreamIdentity {
  std::string stream_id;          // telemetry.stream_id
  std::uint64_t config_hash = 0;  // of the configuration in force
  std::uint64_t run_id = 0;       // drivers/telemetry/run_identity.h; in messages only, never in a result
};

// Destination of results. Called by the publish stage only. A failed send returns false and is counted by the caller.
class Publisher {
 public:
  virtual ~Publisher() = default;
  virtual bool publish(const core::ModalEstimate& estimate,
                       const std::vector<core::ChannelInfo>& channels) noexcept = 0;
  virtual bool publish(const core::DisplacementSample& sample,
                       const std::vector<core::ChannelInfo>& channels) noexcept = 0;
  virtual bool publish(const core::TrackFrame& tracks) noexcept = 0;
  virtual bool publish(const core::CpsdSums& spectrum, const std::vector<core::ChannelInfo>& channels) noexcept = 0;
  virtual bool publish(const core::closure::ClosureReport& report) noexcept = 0;
  virtual bool publish(const core::Health& health) noexcept = 0;
  virtual bool publish(const core::Preview& preview, const std::vector<core::Region>& regions) noexcept = 0;
  // Any thread.
  [[nodiscard]] virtual std::uint64_t messages_sent() const noexcept = 0;  // datagrams
  [[nodiscard]] virtual std::uint64_t messages_failed() const noexcept = 0;
};

}  // namespace drivers
