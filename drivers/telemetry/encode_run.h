#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/types/run_record.h"
#include "drivers/telemetry/publisher.h"
#include "hovermodal/run_file_t.hpp"
#include "hovermodal/run_frame_t.hpp"
#include "hovermodal/run_recording_t.hpp"
#include "hovermodal/run_t.hpp"
#include "hovermodal/run_thinned_frame_t.hpp"

namespace drivers {

// A recorded run to messages and back: every number is exact to the last bit.

inline constexpr const char* kRunSuffix = "_RUN";
inline constexpr const char* kRunAircraftSuffix = "_RUN_AIRCRAFT";
inline constexpr const char* kRunFileSuffix = "_RUN_FILE";
inline constexpr const char* kRunFrameSuffix = "_RUN_FRAME";
inline constexpr const char* kRunRecordingSuffix = "_RUN_RECORDING";
inline constexpr const char* kRunThinnedFrameSuffix = "_RUN_THINNED_FRAME";
inline constexpr std::size_t kFilePieceBytes = std::size_t{256} << 10;

[[nodiscard]] hovermodal::run_t to_message(const core::RunHead& head, const StreamIdentity& identity);
[[nodiscard]] std::vector<hovermodal::run_file_t> to_messages(const core::NamedFile& file);
[[nodiscard]] hovermodal::run_frame_t to_message(const core::TrackFrame& tracks, const core::AttitudeBatch& attitude);
[[nodiscard]] hovermodal::run_recording_t to_message(const core::RecordingTimes& times);

// Empty: its values are inconsistent (sizes that differ, an invalid rate).
[[nodiscard]] std::optional<core::RunHead> from_message(const hovermodal::run_t& message);
[[nodiscard]] std::optional<core::RecordingTimes> from_message(const hovermodal::run_recording_t& message);
// `out` is sized as the keyframe. False: the points differ from the keyframe's.
[[nodiscard]] bool take_frame(const hovermodal::run_frame_t& message, core::RecordedFrame& out);
// The same; also false for an invalid stride.
[[nodiscard]] bool take_frame(const hovermodal::run_thinned_frame_t& message, core::RecordedFrame& out);

}  // namespace drivers
