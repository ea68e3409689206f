#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/types/closure_report.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "core/types/preview.h"
#include "core/types/region.h"
#include "core/types/track.h"
#include "drivers/telemetry/publisher.h"
#include "hovermodal/closure_report_t.hpp"
#include "hovermodal/displacement_t.hpp"
#include "hovermodal/health_t.hpp"
#include "hovermodal/modal_estimate_t.hpp"
#include "hovermodal/preview_t.hpp"
#include "hovermodal/spectrum_t.hpp"
#include "hovermodal/tracks_t.hpp"

namespace drivers {

// From the plain types of `core` to messages. Pure: `sequence` and `utc_ns` are left 0 for the sender to fill.
// Meaning, unit and "unknown" value of every field are documented in messages/*.lcm.

// A part of an estimate never exceeds this when encoded (unless a single mode does): with LCM's header and channel name
// it stays under 1400 bytes, and so in one Ethernet frame.
inline constexpr int kMaxModalPartBytes = 1300;
inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
inline constexpr std::size_t kMaxNameBytes = 64;
inline constexpr std::size_t kMaxReasonBytes = 120;
inline constexpr std::size_t kMaxWarningBytes = 200;
inline constexpr std::size_t kMaxWarnings = 16;

[[nodiscard]] std::vector<hovermodal::modal_estimate_t> to_messages(const core::ModalEstimate& estimate,
                                                                    const std::vector<core::ChannelInfo>& channels,
                                                                    const StreamIdentity& identity);

// One message per channel. Empty unless the sums contain n_bins x n_pairs values.
[[nodiscard]] std::vector<hovermodal::spectrum_t> to_messages(const core::CpsdSums& sums,
                                                              const std::vector<core::ChannelInfo>& channels,
                                                              const StreamIdentity& identity);

[[nodiscard]] hovermodal::displacement_t to_message(const core::DisplacementSample& sample,
                                                    const StreamIdentity& identity);
// One datagram: texts are clipped, and steps that do not fit are left out, the last first.
[[nodiscard]] hovermodal::closure_report_t to_message(const core::closure::ClosureReport& report,
                                                      const StreamIdentity& identity);
[[nodiscard]] hovermodal::tracks_t to_message(const core::TrackFrame& tracks, const StreamIdentity& identity);
// Throws std::runtime_error if the image cannot be encoded. More than a thousand points are thinned evenly.
[[nodiscard]] hovermodal::preview_t to_message(const core::Preview& preview, const std::vector<core::Region>& regions,
                                               const StreamIdentity& identity);
[[nodiscard]] hovermodal::health_t to_message(const core::Health& health,
                                              const std::vector<core::ChannelInfo>& channels,
                                              const StreamIdentity& identity);

// At most `max_bytes`, cut between UTF-8 characters; ends at an embedded zero, as LCM strings do.
[[nodiscard]] std::string clipped(std::string_view text, std::size_t max_bytes);

template <class Message>
[[nodiscard]] Message begin_message(const StreamIdentity& identity, std::int64_t stream_time_ns) {
  Message message{};
  message.stream_id = clipped(identity.stream_id, kMaxNameBytes);
  message.stream_time_ns = stream_time_ns;
  message.config_hash = static_cast<std::int64_t>(identity.config_hash);
  message.run_id = static_cast<std::int64_t>(identity.run_id);
  return message;
}

// A count or index in the bits it has on the wire; saturates.
[[nodiscard]] constexpr std::int16_t to_int16(std::uint64_t value) noexcept {
  return value > INT16_MAX ? std::int16_t{INT16_MAX} : static_cast<std::int16_t>(value);
}
[[nodiscard]] constexpr std::int32_t to_int32(std::uint64_t value) noexcept {
  return value > INT32_MAX ? std::int32_t{INT32_MAX} : static_cast<std::int32_t>(value);
}

}  // namespace drivers
