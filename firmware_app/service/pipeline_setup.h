#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/geometry/channel_displacement.h"
#include "core/geometry/readout_estimator.h"
#include "core/tracking/preview_maker.h"
#include "core/tracking/structure_tracker.h"
#include "core/types/frame.h"
#include "drivers/camera/camera.h"
#include "drivers/telemetry/attitude_listener.h"
#include "drivers/telemetry/publisher.h"
#include "firmware_app/chain/mode_identification.h"
#include "firmware_app/chain/spectrum_accumulator.h"
#include "firmware_app/chain/state/run_state.h"
#include "firmware_app/config/config.h"
#include "firmware_app/report/run_report.h"
#include "firmware_app/service/health.h"
#include "firmware_app/service/kept_keyframe.h"
#include "firmware_app/service/stages/items.h"
#include "firmware_app/service/stages/publish_stage.h"
#include "rt/stage_runner.h"

namespace app {

// The beginning of the data flow, once the first frame is there: everything behind it can then be sized.
struct Source {
  // Starts the camera, takes one frame, seeds the points, or finds those of an earlier run's keyframe. Throws
  // ConfigError when configuration and source do not fit, std::runtime_error when no frame comes.
  Source(std::unique_ptr<drivers::Camera> opened, const AppConfig& config);

  [[nodiscard]] const std::vector<core::ChannelInfo>& channels() const noexcept { return displacement.channels(); }
  // What displacements are measured from.
  [[nodiscard]] const core::Frame& keyframe_image() const noexcept { return kept ? kept->image : first_frame; }

  std::unique_ptr<drivers::Camera> camera;
  core::CameraInfo info;
  core::Frame first_frame;
  std::string datum;                 // what became of an earlier run's keyframe; empty: there was none
  std::optional<KeptKeyframe> kept;  // that keyframe, where the view is still the same
  core::StructureTracker tracker;
  core::TrackFrame keyframe;
  core::ChannelDisplacement displacement;
  core::ReadoutEstimator readout;
};

[[nodiscard]] std::unique_ptr<drivers::Camera> open_camera(const AppConfig& config);
[[nodiscard]] std::unique_ptr<drivers::AttitudeListener> open_attitude(const AppConfig& config);  // null: none wanted
[[nodiscard]] std::unique_ptr<drivers::RunRecorder> open_recorder(const AppConfig& config);       // null: none wanted
[[nodiscard]] std::unique_ptr<drivers::Publisher> open_publisher(const AppConfig& config,
                                                                 drivers::RunRecorder* recorder, std::string& warning);
[[nodiscard]] std::unique_ptr<RunReport> open_report(const AppConfig& config,
                                                     const Source& source);  // null: none wanted
// What to say of a record shorter than one segment, which a source of unknown length may turn out to be; else empty.
[[nodiscard]] std::string short_record(const AppConfig& config, const core::CameraInfo& info,
                                       const core::ModalEstimate& estimate);
// What PublishStage::Outlets::draw calls; empty: no report wanted. All arguments must outlive it.
[[nodiscard]] std::function<void(const PublishStage::Findings&, const core::Health&)> picture_drawer(
    const AppConfig& config, const Source& source, const RunReport* report);
[[nodiscard]] core::PreviewMaker preview_maker_for(const AppConfig& config, const Source& source);
[[nodiscard]] FrameRecord record_prototype(const Source& source);
// What a kept state must agree with.
[[nodiscard]] RunState view_of(const AppConfig& config, const Source& source);
[[nodiscard]] std::string state_path(const AppConfig& config);     // empty: none is kept
[[nodiscard]] std::string keyframe_path(const AppConfig& config);  // beside it
// Keeps the keyframe for a later run; tells in health what became of the last one's, and a failure.
void keep_keyframe(const AppConfig& config, const Source& source, HealthCollector& health);
// Goes on with the state found at `path`; says so, or why not, in health. That state, its boot_id empty where the clock
// behind the stamps is another one; empty: the record begins anew.
[[nodiscard]] std::optional<RunState> resume_state(const std::string& path, const RunState& view,
                                                   SpectrumAccumulator& spectra, ModeIdentification& modes,
                                                   HealthCollector& health);

// A real-time setting that the system refuses: an error when rt.required, else a warning in every status record.
void refuse_or_warn(const RtConfig& config, const std::string& refused, HealthCollector& health);
// Threads that frames pass through get rt.priority, their CPU, and a stack that is mapped beforehand.
[[nodiscard]] rt::ThreadConfig frame_thread(std::string name, const RtConfig& config, int cpu);
[[nodiscard]] std::string event_line(std::string_view stage, const rt::Event& event);
void start_runner(rt::StageRunner& runner, const RtConfig& config, HealthCollector& health);

// Thrown by refuse_or_warn() and start_runner() (exit code 4).
class RealTimeRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace app
