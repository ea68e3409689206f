// hovermodal batch-flight: the process that analyses one flight of a batch. A crash here affects one flight only.
#include <fmt/core.h>
#include <sys/prctl.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <thread>

#include "drivers/host/command_line.h"
#include "drivers/storage/checkpoint_file.h"
#include "drivers/storage/printable.h"
#include "firmware_app/chain/state/setup_sums.h"
#include "firmware_app/replay/analysis.h"
#include "firmware_app/service/pipeline.h"
#include "tools/hovermodal/batch/flight_order.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/modes_text.h"

namespace tools {

namespace {

namespace fs = std::filesystem;

constexpr const char* kKeepsNone = "report.keep=0";  // a batch that is repeated gives the same again

void say(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) fmt::print("{}\n", drivers::printable_lines(line));
}

app::TracksResult replayed_record(const FlightOrder& order, const std::string& path,
                                  const std::vector<std::string>& overrides) {
  std::vector<std::string> all = overrides;
  all.emplace_back(kKeepsNone);
  app::RecordsResult result = app::replay_records({path}, {"", all, true}, order.into);
  say(result.remarks);
  return std::move(result.tracks);
}

// Reports without corrections change nothing that is recorded, and take seconds each.
void skip_closure_reports(app::AppConfig& config) {
  if (config.closure.adopt == app::ClosureAdopt::kReport) config.closure.adopt = app::ClosureAdopt::kOff;
}

// Runs the service on the clip and records it; the replay continues from the record.
void track_clip(const FlightOrder& order, const fs::path& records) {
  std::vector<std::string> overrides = order.overrides;
  overrides.insert(overrides.end(),
                   {"camera.driver=file", "camera.source=" + order.flight.path, "camera.pace=as_fast_as_possible",
                    "telemetry.lcm_url=", "telemetry.log_file=", "state.directory=", "report.directory=",
                    "record.directory=" + records.string(), "record.quota_mb=1000000"});
  app::AppConfig config = app::load_config(order.flight.config, overrides);
  skip_closure_reports(config);
  app::Pipeline pipeline(config);
  say(pipeline.warnings());
  pipeline.start();
  while (pipeline.running()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const app::Pipeline::Outcome outcome = pipeline.join();
  say(pipeline.take_events());
  say(outcome.notes);
  if (!outcome.fault.empty()) throw std::runtime_error(outcome.fault);
}

app::TracksResult tracked_clip(const FlightOrder& order) {
  const fs::path records = fs::path(order.into) / "record";
  fs::remove_all(records);
  track_clip(order, records);
  const std::vector<Flight> found = find_flights(records.string(), "", "").flights;
  if (found.empty())
    throw std::runtime_error("the clip left no record: this build may lack LCM, which records are written with");
  app::TracksResult result = replayed_record(order, found.front().path, {});
  fs::remove_all(records);  // large, and can be regenerated from the clip
  return result;
}

app::TracksResult result_of(const FlightOrder& order) {
  switch (order.flight.kind) {
    case FlightKind::kRecord:
      return replayed_record(order, order.flight.path, order.overrides);
    case FlightKind::kTracks: {
      std::vector<std::string> overrides = order.overrides;
      overrides.emplace_back(kKeepsNone);
      app::AppConfig config = app::load_config(order.flight.config, overrides);
      skip_closure_reports(config);
      return app::replay_tracks(config, order.flight.path, order.into);
    }
    case FlightKind::kClip:
      return tracked_clip(order);
  }
  throw std::invalid_argument("no such kind of flight");
}

// Geometry, spectra and identification as in `replay`; for a clip, tracking first. Writes the report and kSumsFile to
// the folder.
void work_on(const FlightOrder& order) {
  const app::TracksResult result = result_of(order);
  say(result.changes);
  fmt::print("{}", modes_text(result.estimate, result.channels));
  const std::string refused =
      drivers::write_checkpoint((fs::path(order.into) / kSumsFile).string(), app::to_bytes(result.sums));
  if (!refused.empty()) throw std::runtime_error(fmt::format("{}: {}", kSumsFile, refused));
}

}  // namespace

void add_batch_flight(drivers::Command& app) {
  auto order = std::make_shared<FlightOrder>();
  auto kind = std::make_shared<std::string>();
  drivers::Command command = app.subcommand("batch-flight", "One flight of a batch");
  command.hide();
  command.option("--kind", *kind).required();
  command.option("--path", order->flight.path).required();
  command.option("--into", order->into).required();
  command.option("--config", order->flight.config);
  command.option("--set", order->overrides).repeated();
  command.on_run([order, kind] {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // ends with the process that waits for this flight
    order->flight.kind = flight_kind(*kind);
    work_on(*order);
  });
}

}  // namespace tools
