#include <string>

#include "firmware_app/config/config_sections.h"

namespace app {
namespace {

using A = AppConfig;

}  // namespace

void add_tracking_keys(std::vector<ConfigKey>& keys) {
  using C = TrackingConfig;
  const auto whole = [&](const char* name, const char* unit, int C::*member, NumberRange range, const char* meaning) {
    keys.push_back(whole_key(std::string("tracking.") + name, unit, at(&A::tracking, member), range, meaning));
  };
  const auto number = [&](const char* name, const char* unit, double C::*member, NumberRange range,
                          const char* meaning) {
    keys.push_back(number_key(std::string("tracking.") + name, unit, at(&A::tracking, member), range, meaning));
  };
  whole("points_per_region", "", &C::points_per_region, {1, 1000}, "number of corners to find in each region");
  number("min_distance_px", "px", &C::min_distance_px, {1, 1000}, "smallest distance between two corners");
  number("corner_quality", "", &C::corner_quality, {1e-6, 1},
         "smallest Harris response of a corner, relative to the region's strongest corner");
  whole("window_px", "px", &C::window_px, {5, 21}, "side of the square patch that is tracked");
  whole("max_iterations", "", &C::max_iterations, {2, 1000}, "largest number of iterations of the tracker per point");
  number("reach_px", "px", &C::reach_px, {0.5, 16}, "search radius of a point around its predicted position");
  number("search_px", "px", &C::search_px, {16, 1000},
         "search radius of a whole region when most of its points are not found at their predicted "
         "positions");
  number("least_correlation", "", &C::least_correlation, {0.1, 1},
         "smallest correlation of a point with its template, relative to what their noise allows; a "
         "point below it is lost");
  number("inlier_sigma_px", "px", &C::inlier_sigma_px, {1e-3, 100},
         "standard deviation of inliers about their region's motion");
  whole("min_points", "", &C::min_points, {1, 1000},
        "smallest number of inliers; a region with fewer has no sample in that frame");
  whole("reseed_after", "frames", &C::reseed_after, {1, 1000000, true},
        "a point without an inlier sample for this many frames, while its region is measured, is "
        "re-seeded at its original position; its reference position is kept; 0 = never");
}

void add_analysis_keys(std::vector<ConfigKey>& keys) {
  using S = SpectrumConfig;
  keys.push_back(
      whole_key("spectrum.segment", "samples", at(&A::spectrum, &S::segment), {16, 1048576},
                "length of a Welch segment (frequency resolution = frame rate / segment); the record must be "
                "at least this long"));
  keys.push_back(number_key("spectrum.overlap", "", at(&A::spectrum, &S::overlap), {0, 0.95},
                            "overlap of neighbouring segments, as a share of their length"));
  keys.push_back(text_choice_key("spectrum.window", at(&A::spectrum, &S::window), {"hann", "hamming", "boxcar"},
                                 "window function of a segment"));
  keys.push_back(
      number_key("spectrum.forget_s", "s", at(&A::spectrum, &S::forget_s), {1, 1e7, true},
                 "time constant of forgetting: a segment is weighted by exp(-age / forget_s), for a structure "
                 "that changes; 0 = all segments count alike"));
  keys.push_back(switch_key(
      "spectrum.witness", at(&A::spectrum, &S::witness),
      "unless scale.only is false: treat motion coherent with a static region (background, ground) as camera "
      "motion and remove it from the mode shapes; beside a base, and for the camera's roll, it is a measured "
      "input of the identification"));
  using I = IdentificationConfig;
  keys.push_back(whole_key("identification.period", "hops", at(&A::identification, &I::period_hops), {1, 1000000},
                           "number of hops between two estimates (one hop = segment * (1 - overlap) samples). A run "
                           "begins with estimates after 1, 2, 4 ... segments; one more is made at its end"));
  keys.push_back(texts_key("identification.references", at(&A::identification, &I::references), {1, 40, true},
                           "reference channels of the correlations; [] = automatic"));
  keys.push_back(whole_key("identification.block_rows", "", at(&A::identification, &I::block_rows), {2, 1000, true},
                           "block rows of the Hankel matrix; 0 = automatic"));
  keys.push_back(whole_key("identification.max_order", "", at(&A::identification, &I::max_order), {2, 500, true},
                           "highest model order; 0 = automatic; with method paper, the order: 0 = 36"));
  keys.push_back(number_key("identification.max_frequency_hz", "Hz", at(&A::identification, &I::max_frequency_hz),
                            {1e-6, 1e6, true},
                            "highest true frequency of interest; if above half the frame rate (Nyquist frequency), the "
                            "alias order of each mode is determined from row delays; 0 = half the frame rate"));
  keys.push_back(
      number_key("identification.min_mpc", "", at(&A::identification, &I::min_mpc), {0, 1},
                 "smallest modal phase collinearity (MPC) of a structural mode; method paper does not use it"));
  keys.push_back(number_key("identification.max_damping", "", at(&A::identification, &I::max_damping), {1e-4, 1},
                            "largest damping ratio of a structural mode"));
}

void add_closure_keys(std::vector<ConfigKey>& keys) {
  using C = ClosureConfig;
  keys.push_back(choice_key<ClosureAdopt>(
      "closure.adopt", [](AppConfig& config, std::size_t) -> ClosureAdopt& { return config.closure.adopt; },
      {{"off", ClosureAdopt::kOff}, {"report", ClosureAdopt::kReport}, {"auto", ClosureAdopt::kAuto}},
      "diagnosis of effects that the model of camera, lens and tracker does not explain in the "
      "tracks. off: disabled; report: name the effect; auto: also correct constant effects "
      "(readout time, lens, pixel locking) once two consecutive reports agree, by measuring the run "
      "again (up to 64 MB of points), and withdraw a correction that no longer helps"));
  keys.push_back(number_key("closure.window_s", "s", at(&A::closure, &C::window_s), {20, 3600},
                            "length of the window of newest tracks that each report analyses"));
  keys.push_back(
      whole_key("closure.points_per_region", "", at(&A::closure, &C::points_per_region), {2, 1000},
                "number of points per region that each report analyses; 100 points over 120 s at 60 frames/s "
                "need about 300 MB and ten seconds of a fast processor core, at ordinary priority"));
  keys.push_back(number_key("closure.period_s", "s", at(&A::closure, &C::period_s), {20, 86400},
                            "stream time between two reports; the first needs 20 s of record"));
  keys.push_back(number_key("closure.least_px", "px", at(&A::closure, &C::least_px), {0, 10},
                            "smallest effect that is reported: rms displacement over the analysed points and frames"));
  keys.push_back(number_key("closure.delay_s", "s", at(&A::closure, &C::delay_s), {0, 3600},
                            "delay from the last frame of a report to the first frame that it corrects, at most "
                            "closure.period_s; if it is longer than a report takes, a replay corrects from the same "
                            "frame on"));
  keys.push_back(
      text_key("closure.structure", at(&A::closure, &C::structure), {},
               "file of a declared structure (tower, beam, cable, frame, matrices; tools/guide/structures.md), "
               "which is compared with the modes every closure.period_s and at the end of a recording: which effect it "
               "lacks, and where; "
               "\"\" = none"));
}

void add_telemetry_keys(std::vector<ConfigKey>& keys) {
  using T = TelemetryConfig;
  keys.push_back(text_key("telemetry.lcm_url", at(&A::telemetry, &T::lcm_url), {},
                          "URL to which LCM messages are sent; \"\" = no telemetry"));
  keys.push_back(text_key("telemetry.channel_prefix", at(&A::telemetry, &T::channel_prefix), {1, 32, true},
                          "prefix of the name of every LCM channel"));
  keys.push_back(text_key("telemetry.stream_id", at(&A::telemetry, &T::stream_id), {1, 64, true},
                          "name of this service in every message"));
  keys.push_back(text_key("telemetry.log_file", at(&A::telemetry, &T::log_file), {},
                          "LCM log file to which messages are written in addition; \"\" = none"));
  keys.push_back(whole_key("telemetry.tracks_every", "frames", at(&A::telemetry, &T::tracks_every), {0, 1000000},
                           "publish every n-th frame's tracks; 0 = never"));
  keys.push_back(whole_key("telemetry.displacement_every", "frames", at(&A::telemetry, &T::displacement_every),
                           {1, 1000000}, "publish every n-th displacement"));
  keys.push_back(number_key("telemetry.max_kbit_s", "kbit/s", at(&A::telemetry, &T::max_kbit_s), {16, 1e6, true},
                            "limit of the network data rate: modes, health and closure are always sent; displacements, "
                            "spectra and tracks are thinned out and counted in health; for a radio set four fifths of "
                            "its capacity (200 of 256); a log file receives everything; 0 = no limit"));
  keys.push_back(number_key("telemetry.preview_period_s", "s", at(&A::telemetry, &T::preview_period_s), {0, 86400},
                            "stream time between two preview images for the ground, about 10 kB each; 0 = none"));
  keys.push_back(whole_key("telemetry.preview_px", "px", at(&A::telemetry, &T::preview_px), {64, 1024},
                           "largest long side of a preview image"));
}

void add_report_keys(std::vector<ConfigKey>& keys) {
  keys.push_back(text_key("report.directory", at(&A::report, &ReportConfig::directory), {},
                          "folder for modal.json and CSV files; \"\" = none; --report takes precedence"));
  keys.push_back(
      switch_key("report.tracks", at(&A::report, &ReportConfig::tracks), "also write tracks.csv (the largest file)"));
  keys.push_back(whole_key("report.keep", "reports", at(&A::report, &ReportConfig::keep), {0, 100},
                           "earlier reports that stay in report.directory, in folders report.1 (the newest), report.2, "
                           "...; a new report replaces the last one only when it is complete"));
  keys.push_back(text_key("report.title", at(&A::report, &ReportConfig::title), {0, 120},
                          "title of report.html, for example the structure's name; \"\" = none"));
  keys.push_back(texts_key("report.notes", at(&A::report, &ReportConfig::notes), {1, 300, false, 24},
                           "lines for the head of report.html: \"date: ...\", \"place: ...\", \"structure: ...\", "
                           "\"operator: ...\" and others of this form become a list of facts, the rest a text"));
  keys.push_back(text_key("report.compare", at(&A::report, &ReportConfig::compare), {},
                          "modal.json of a former run, or truth.json of a model, with which report.html compares the "
                          "modes; \"\" = none"));
}

void add_storage_keys(std::vector<ConfigKey>& keys) {
  using O = RecordConfig;
  keys.push_back(text_key("record.directory", at(&A::record, &O::directory), {},
                          "folder for run records (LCM event logs with messages, every point in full precision, and "
                          "the configuration), from which `hovermodal replay` reproduces the same estimates; \"\" = "
                          "none"));
  keys.push_back(whole_key("record.file_mb", "MB", at(&A::record, &O::file_mb), {1, 100000},
                           "size at which a record file is closed and the next one begins"));
  keys.push_back(whole_key("record.quota_mb", "MB", at(&A::record, &O::quota_mb), {2, 100000000},
                           "limit for all records in the folder: the oldest runs are deleted to make room; if only the "
                           "present run is left, its recording stops"));
  using P = StateConfig;
  keys.push_back(text_key("state.directory", at(&A::state, &P::directory), {},
                          "folder (created if missing) for checkpoints of spectra and modes, against loss of power; a "
                          "run resumes from a checkpoint of the same configuration and view; \"\" = none"));
  keys.push_back(number_key("state.period_s", "s", at(&A::state, &P::period_s), {0.1, 86400},
                            "stream time between two checkpoints: the largest part of the record that a loss of power "
                            "can cost"));
}

void add_real_time_keys(std::vector<ConfigKey>& keys) {
  using R = RtConfig;
  keys.push_back(switch_key("rt.required", at(&A::rt, &R::required),
                            "refuse to run if priority or memory lock is denied (exit code 4)"));
  keys.push_back(whole_key("rt.priority", "", at(&A::rt, &R::priority), {0, 90},
                           "SCHED_FIFO priority of the capture, tracking and spectrum threads; 0 = ordinary threads"));
  const auto cpu = [&](const char* name, int R::*member, const char* meaning) {
    keys.push_back(whole_key(std::string("rt.") + name, "", at(&A::rt, member), {-1, 1023}, meaning));
  };
  cpu("capture_cpu", &R::capture_cpu, "CPU to which the capture thread is pinned; -1 = any");
  cpu("tracking_cpu", &R::tracking_cpu, "CPU to which the tracking thread is pinned; -1 = any");
  cpu("spectrum_cpu", &R::spectrum_cpu, "CPU to which the spectrum thread is pinned; -1 = any");
  keys.push_back(
      number_key("rt.stall_s", "s", at(&A::rt, &R::stall_s), {0.5, 3600},
                 "longest time of one step of a stage; a stage that takes longer is named in health, and the "
                 "watchdog is not fed; identification may take ten times as long"));
  keys.push_back(switch_key("rt.lock_memory", at(&A::rt, &R::lock_memory),
                            "lock the service's memory, so that it is not paged out"));
  keys.push_back(switch_key("rt.thin_overload", at(&A::rt, &R::thin_overload),
                            "with a live source that is too fast for tracking, keep every n-th frame at equal spacing "
                            "and start new spectra at the new rate; false: keep the frames that find room"));
  keys.push_back(whole_key("rt.frame_slots", "", at(&A::rt, &R::frame_slots), {0, 256},
                           "number of frames that can wait for tracking; 0 = 8, or 4 of a source that waits itself"));
  keys.push_back(whole_key("rt.sample_slots", "", at(&A::rt, &R::sample_slots), {2, 65536},
                           "number of samples that can wait for spectra and records"));
}

}  // namespace app
