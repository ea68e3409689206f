#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/structure/declared_frame.h"
#include "core/types/closure_report.h"
#include "firmware_app/chain/makers.h"
#include "firmware_app/config/core_config.h"
#include "firmware_app/service/health.h"
#include "firmware_app/service/kept_state.h"
#include "firmware_app/service/outlets.h"
#include "firmware_app/service/real_time.h"
#include "firmware_app/service/source.h"
#include "firmware_app/service/stages/closure_stage.h"
#include "firmware_app/service/stages/identification_stage.h"
#include "firmware_app/service/stages/structure_stage.h"
#include "rt/stage_runner.h"

namespace app {

// The data flow, top to bottom. Members are destroyed in reverse: threads first, then stages, rings, devices.
struct DataFlow {
  // Opens, reads the first frame, connects. Throws as Pipeline does.
  DataFlow(const AppConfig& c, std::optional<core::structure::DeclaredFrame> declared,
           std::unique_ptr<drivers::Camera> camera, std::unique_ptr<drivers::RunRecorder> record,
           std::unique_ptr<drivers::Publisher> publisher);

  AppConfig config;
  std::optional<core::structure::DeclaredFrame> structure;  // closure.structure; empty: none is declared
  std::string lock_refused;  // why memory is not locked; empty: it is, or was not requested
  Source source;             // camera, its first frame, the points seeded in it, the channels
  std::unique_ptr<drivers::AttitudeListener> attitude = open_attitude(config);  // null: no live attitude
  std::unique_ptr<drivers::AircraftListener> aircraft = open_aircraft(config);  // null: none wanted
  std::unique_ptr<drivers::RunRecorder> recorder;                               // null: the run is not recorded
  std::unique_ptr<drivers::Publisher> out;
  std::unique_ptr<RunReport> report = open_report(config, source);

  // What the stages call: the chain, which a replay runs in one loop (TrackAnalysis).
  CorrectionLog book;  // corrections by the diagnosis beyond what was declared
  TrackLattice lattice{source.keyframe};
  DisplacementMeter meter{source.displacement, source.readout, takes_out() ? &lattice : nullptr};
  core::WelchConfig welch = welch_config(config.spectrum, source.displacement.spectra().size(), source.info.rate_hz,
                                         source.displacement.n_witnesses());
  SpectrumAccumulator spectra{welch, config.identification.period_hops};
  ModeIdentification modes{source.info.rate_hz,
                           identifier_maker(config, source.info, source.keyframe, source.displacement.spectra()), book,
                           motor_lines(config)};
  Diagnosis diagnosis{missing_effect_search_config(config, source.info, source.keyframe), book,
                      geometry_maker(config, source.info, source.keyframe),
                      past_of(config, source.info, source.keyframe, source.displacement, config.record.directory)};
  StructureComparison comparison{structure.value_or(core::structure::DeclaredFrame{}), source.channels(),
                                 config.closure.period_s};
  core::PreviewMaker preview_maker = preview_maker_for(config, source);

  // camera -> [frames] -> tracking -> [samples] -> spectrum -> [snapshots] -> identification -> [results] -> publish
  //                                -> [records], (previews) -> publish
  //                                -> [recent_tracks] -> closure -> [closures] -> publish; [correction_switches] ->
  //                                tracking
  // identification -> (estimates) -> structure -> [comparisons] -> publish
  // tracking -> [aircraft_updates] -> spectrum
  // spectrum, identification -> (spectrum_states, mode_states) -> checkpoint -> the state file
  rt::SpscRing<core::Frame> frames{frame_slots(), source.first_frame};
  rt::SpscRing<core::DisplacementSample> samples{slots(config.rt.sample_slots), source.displacement.sample_prototype()};
  rt::SpscRing<FrameRecord> records{slots(config.rt.sample_slots), record_prototype(source)};
  rt::TripleBuffer<core::Preview> previews{preview_maker.prototype()};
  rt::SpscRing<SpectrumSnapshot> snapshots{slots(source.info.lossless ? 1 : kEstimateSlots),
                                           SpectrumSnapshot{core::WelchCpsd::empty_sums(welch)}};
  rt::SpscRing<IdentificationResult> results{slots(kEstimateSlots), IdentificationResult{}};
  rt::SpscRing<ShownFrame> recent_tracks{closes_loop() ? slots(kRecentSlots) : 1, ShownFrame{source.keyframe}};
  rt::SpscRing<core::closure::ClosureReport> closures{slots(kResultSlots), core::closure::ClosureReport{}};
  rt::TripleBuffer<core::ModalEstimate> estimates{core::ModalEstimate{}};
  rt::SpscRing<core::closure::ClosureReport> comparisons{slots(kResultSlots), core::closure::ClosureReport{}};
  rt::SpscRing<AircraftUpdate> aircraft_updates{slots(aircraft ? kAircraftSlots : 1), AircraftUpdate{}};
  rt::SpscRing<CorrectionSwitch> correction_switches{slots(kResultSlots), CorrectionSwitch{}};
  rt::SpscRing<Takeover> takeovers{slots(kResultSlots), Takeover{}};
  rt::TripleBuffer<StateBytes> spectrum_states{state_room(spectra.state_bytes())};
  rt::TripleBuffer<StateBytes> mode_states{state_room(modes.state_bytes())};

  CaptureStage capture{*source.camera, frames.writer(), source.first_frame, config.rt.thin_overload};
  TrackingStage tracking{
      {frames.reader(), samples.writer(), records.writer(), previews,
       attitude ? std::optional(attitude->samples()) : std::nullopt,
       aircraft ? std::optional(aircraft->samples()) : std::nullopt,
       where(aircraft != nullptr, aircraft_updates.writer()), where(closes_loop(), recent_tracks.writer()),
       where(takes_out(), correction_switches.reader()), where(takes_out(), takeovers.writer())},
      {source.tracker, meter, preview_maker, capture.thinning()},
      source.info.lossless,
      diagnosis.change()};
  SpectrumStage spectrum{
      {samples.reader(), snapshots.writer(), keeps_state() ? &spectrum_states : nullptr,
       where(aircraft != nullptr, aircraft_updates.reader()), where(takes_out(), takeovers.reader())},
      spectra,
      source.info.lossless};
  IdentificationStage identification{{snapshots.reader(), results.writer(), keeps_state() ? &mode_states : nullptr,
                                      compares_structure() ? &estimates : nullptr},
                                     modes};
  ClosureStage closure{{recent_tracks.reader(), closures.writer(), where(takes_out(), correction_switches.writer())},
                       diagnosis};
  StructureStage structure_stage{{estimates, comparisons.writer()}, comparison};
  CheckpointStage checkpoint{spectrum_states, mode_states, view_of(config, source), state_path(config)};
  HealthCollector health{source.info.rate_hz, capture, tracking, spectrum};
  PublishStage publish{{records.reader(), results.reader(), previews, where(closes_loop(), closures.reader()),
                        where(compares_structure(), comparisons.reader())},
                       outlets()};

  // Started back to front, stopped front to back.
  rt::StageRunner run_capture{capture, frame_thread("hm-capture", config.rt, config.rt.capture_cpu)};
  rt::StageRunner run_tracking{tracking, frame_thread("hm-tracking", config.rt, config.rt.tracking_cpu)};
  rt::StageRunner run_spectrum{spectrum, frame_thread("hm-spectrum", config.rt, config.rt.spectrum_cpu)};
  rt::StageRunner run_identification{identification, {"hm-identify"}};
  rt::StageRunner run_closure{closure, {"hm-closure"}};
  rt::StageRunner run_structure{structure_stage, {"hm-structure"}};
  rt::StageRunner run_publish{publish, {"hm-publish"}};
  rt::StageRunner run_checkpoint{checkpoint, {"hm-checkpoint"}};
  const std::vector<rt::StageRunner*> runners = list_runners();  // in flow order

  [[nodiscard]] bool closes_loop() const noexcept { return config.closure.adopt != ClosureAdopt::kOff; }
  [[nodiscard]] bool takes_out() const noexcept { return config.closure.adopt == ClosureAdopt::kAuto; }
  [[nodiscard]] bool compares_structure() const noexcept { return structure && closes_loop(); }
  [[nodiscard]] bool keeps_state() const noexcept { return !config.state.directory.empty(); }
  [[nodiscard]] std::string fault();         // what ended the flow; empty: no fault
  [[nodiscard]] core::Health status();       // present counters
  [[nodiscard]] core::Health host_status();  // and those of the computer; reads files

 private:
  static constexpr int kResultSlots = 8, kEstimateSlots = 2, kLiveSlots = 8, kLosslessSlots = 4, kRecentSlots = 1024,
                       kAircraftSlots = 64;
  static std::size_t slots(int n) { return static_cast<std::size_t>(n); }
  [[nodiscard]] std::size_t frame_slots() const {
    const int chosen = source.info.lossless ? kLosslessSlots : kLiveSlots;
    return slots(config.rt.frame_slots > 0 ? std::max(config.rt.frame_slots, 2) : chosen);
  }
  template <class End>
  static std::optional<End> where(bool is_wanted, End end) {
    return is_wanted ? std::optional<End>(std::move(end)) : std::nullopt;
  }
  [[nodiscard]] StateBytes state_room(std::size_t n_bytes) const {
    return {std::vector<std::uint8_t>(keeps_state() ? n_bytes : 0), 0};
  }
  [[nodiscard]] std::vector<rt::StageRunner*> list_runners();
  [[nodiscard]] PublishStage::Outlets outlets();
  void connect();  // which ring wakes which stage
  void watch();    // registers what a status record counts
  [[nodiscard]] std::optional<RunState> keep_state();
};

}  // namespace app
