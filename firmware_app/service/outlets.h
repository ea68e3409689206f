#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/motion_axes.h"
#include "core/tracking/preview_maker.h"
#include "drivers/storage/folder_claim.h"
#include "drivers/telemetry/publisher.h"
#include "drivers/telemetry/run_recorder.h"
#include "firmware_app/config/config.h"
#include "firmware_app/report/run_report.h"
#include "firmware_app/service/source.h"
#include "firmware_app/service/stages/items.h"
#include "firmware_app/service/stages/publish_stage.h"
#include "rt/event_log.h"

namespace app {

// The folders of report, record and state, for this process alone. Throws drivers::FolderInUse where another process
// writes into one, drivers::FileError where report or record cannot be written; the state's fault is `warning`.
[[nodiscard]] std::vector<std::shared_ptr<drivers::FolderClaim>> claim_folders(const AppConfig& config,
                                                                               std::string& warning);
[[nodiscard]] std::unique_ptr<drivers::RunRecorder> open_recorder(const AppConfig& config);  // null: none wanted
[[nodiscard]] std::unique_ptr<drivers::Publisher> open_publisher(const AppConfig& config,
                                                                 drivers::RunRecorder* recorder, std::string& warning);
[[nodiscard]] std::unique_ptr<RunReport> open_report(const AppConfig& config,
                                                     const Source& source);  // null: none wanted
// Warning for a record shorter than one segment, which is possible for a source of unknown length; otherwise empty.
[[nodiscard]] std::string short_record(const AppConfig& config, const core::CameraInfo& info,
                                       const core::ModalEstimate& estimate);
// The function for PublishStage::Outlets::draw; empty: no report requested. All arguments must outlive it.
[[nodiscard]] std::function<void(const PublishStage::Findings&, const core::Health&, const std::string&)>
picture_drawer(const AppConfig& config, const Source& source, const RunReport* report, const core::MotionAxes& axes);
[[nodiscard]] core::PreviewMaker preview_maker_for(const AppConfig& config, const Source& source);
[[nodiscard]] FrameRecord record_prototype(const Source& source);
[[nodiscard]] std::string event_line(std::string_view stage, const rt::Event& event);

}  // namespace app
