#include <string>

#include "firmware_app/config_sections.h"

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
  whole("points_per_region", "", &C::points_per_region, {1, 1000}, "corners looked for in each region");
  number("min_distance_px", "px", &C::min_distance_px, {1, 1000}, "between two corners");
  number("corner_quality", "", &C::corner_quality, {1e-6, 1},
         "Harris response relative to the region's strongest corner");
  whole("window_px", "px", &C::window_px, {5, 21}, "side of the tracked patch");
  whole("max_iterations", "", &C::max_iterations, {2, 1000}, "of the tracker");
  number("epsilon_px", "px", &C::epsilon_px, {1e-6, 1}, "the tracker stops when a step is smaller");
  number("reach_px", "px", &C::reach_px, {0.5, 16}, "how far from its prediction a point is looked for");
  number("search_px", "px", &C::search_px, {16, 1000},
         "how far a whole region is searched for when most of its points are not where they were expected");
  number("least_correlation", "", &C::least_correlation, {0.1, 1},
         "of a point with its template, relative to what their noise allows; below it is lost");
  number("inlier_sigma_px", "px", &C::inlier_sigma_px, {1e-3, 100},
         "spread of points that agree with their region's motion");
  whole("min_points", "", &C::min_points, {1, 1000}, "a region with fewer agreeing points has no sample in that frame");
  whole("reseed_after", "frames", &C::reseed_after, {1, 1000000, true},
        "a point that its region has done without for so long is tracked by what is now at its place, its datum kept; "
        "0 = never");
}

void add_analysis_keys(std::vector<ConfigKey>& keys) {
  using S = SpectrumConfig;
  keys.push_back(whole_key("spectrum.segment", "samples", at(&A::spectrum, &S::segment), {16, 1048576},
                           "length of a Welch segment; the record must be at least this long"));
  keys.push_back(
      number_key("spectrum.overlap", "", at(&A::spectrum, &S::overlap), {0, 0.95}, "of neighbouring segments"));
  keys.push_back(text_choice_key("spectrum.window", at(&A::spectrum, &S::window), {"hann", "hamming", "boxcar"},
                                 "taper of a segment"));
  keys.push_back(number_key("spectrum.forget_s", "s", at(&A::spectrum, &S::forget_s), {1, 1e7, true},
                            "a segment counts exp(-age / this), for a structure that changes; 0 = never forgets"));
  keys.push_back(switch_key("spectrum.witness", at(&A::spectrum, &S::witness),
                            "where the scale alone is followed: take what moves with a region that rests (background, "
                            "ground) for the camera's, and out of the shapes"));
  using I = IdentificationConfig;
  keys.push_back(
      whole_key("identification.period", "hops", at(&A::identification, &I::period_hops), {1, 1000000},
                "an estimate every so many hops (a hop is segment * (1 - overlap) samples), and one at the end"));
  keys.push_back(texts_key("identification.references", at(&A::identification, &I::references), {1, 40, true},
                           "reference channels of the correlations; [] = automatic"));
  keys.push_back(whole_key("identification.block_rows", "", at(&A::identification, &I::block_rows), {2, 1000, true},
                           "of the Hankel matrix; 0 = automatic"));
  keys.push_back(whole_key("identification.max_order", "", at(&A::identification, &I::max_order), {2, 500, true},
                           "highest model order; 0 = automatic; with method paper, the order: 0 = 36"));
  keys.push_back(number_key("identification.max_frequency_hz", "Hz", at(&A::identification, &I::max_frequency_hz),
                            {1e-6, 1e6, true},
                            "highest true frequency looked for; above half the frame rate, modes are unfolded by their "
                            "row delays; 0 = half"));
  keys.push_back(number_key("identification.min_mpc", "", at(&A::identification, &I::min_mpc), {0, 1},
                            "least phase collinearity (MPC) of a structural mode; method paper does not ask for it"));
  keys.push_back(number_key("identification.max_damping", "", at(&A::identification, &I::max_damping), {1e-4, 1},
                            "largest damping ratio of a structural mode"));
}

void add_closure_keys(std::vector<ConfigKey>& keys) {
  using C = ClosureConfig;
  keys.push_back(choice_key<ClosureAdopt>(
      "closure.adopt", [](AppConfig& config, std::size_t) -> ClosureAdopt& { return config.closure.adopt; },
      {{"off", ClosureAdopt::kOff}, {"report", ClosureAdopt::kReport}, {"auto", ClosureAdopt::kAuto}},
      "what the model of camera, lens and tracker fails to explain in the tracks: nobody looks; it is traced to an "
      "effect and reported; or, where constants hold it (readout time, lens, pixel locking) and two reports in a row "
      "agree, it is taken out of all later frames too, and withdrawn when it helps no longer"));
  keys.push_back(number_key("closure.window_s", "s", at(&A::closure, &C::window_s), {20, 3600},
                            "of the newest tracks that are looked at"));
  keys.push_back(whole_key("closure.points_per_region", "", at(&A::closure, &C::points_per_region), {2, 1000},
                           "that are looked at; a hundred points over 120 s at 60 frames a second take some 300 MB "
                           "and ten seconds of a fast processor core, at ordinary priority"));
  keys.push_back(number_key("closure.period_s", "s", at(&A::closure, &C::period_s), {20, 86400},
                            "of stream time between two reports; the first needs 20 s of record"));
  keys.push_back(number_key("closure.least_px", "px", at(&A::closure, &C::least_px), {0, 10},
                            "rms over the points and frames looked at: an effect that moves them less is not told"));
  keys.push_back(number_key("closure.delay_s", "s", at(&A::closure, &C::delay_s), {0, 3600},
                            "from the last frame of a report to the first that it may change: longer than a report "
                            "takes, so that a replay changes at the same frame; no longer than closure.period_s"));
}

void add_output_keys(std::vector<ConfigKey>& keys) {
  using T = TelemetryConfig;
  keys.push_back(
      text_key("telemetry.lcm_url", at(&A::telemetry, &T::lcm_url), {}, "where LCM messages go; \"\" = no telemetry"));
  keys.push_back(text_key("telemetry.channel_prefix", at(&A::telemetry, &T::channel_prefix), {1, 32, true},
                          "start of every LCM channel's name"));
  keys.push_back(text_key("telemetry.stream_id", at(&A::telemetry, &T::stream_id), {1, 64, true},
                          "names this service in every message"));
  keys.push_back(text_key("telemetry.log_file", at(&A::telemetry, &T::log_file), {},
                          "also write the messages to this LCM log; \"\" = none"));
  keys.push_back(whole_key("telemetry.tracks_every", "frames", at(&A::telemetry, &T::tracks_every), {0, 1000000},
                           "publish every n-th frame's tracks; 0 = never"));
  keys.push_back(whole_key("telemetry.displacement_every", "frames", at(&A::telemetry, &T::displacement_every),
                           {1, 1000000}, "publish every n-th displacement"));
  keys.push_back(number_key("telemetry.max_kbit_s", "kbit/s", at(&A::telemetry, &T::max_kbit_s), {16, 1e6, true},
                            "most that goes over the network: modes, health and closure always do, displacements, "
                            "spectra and tracks are thinned out, counted in health; for a radio take four fifths of "
                            "what it carries (200 of 256); a log file has everything; 0 = no limit"));
  keys.push_back(number_key("telemetry.preview_period_s", "s", at(&A::telemetry, &T::preview_period_s), {0, 86400},
                            "of stream time between two small pictures for the ground, some 10 kB each; 0 = none"));
  keys.push_back(whole_key("telemetry.preview_px", "px", at(&A::telemetry, &T::preview_px), {64, 1024},
                           "long side of such a picture, at most"));
  keys.push_back(text_key("report.directory", at(&A::report, &ReportConfig::directory), {},
                          "folder for modal.json and CSV files; \"\" = none; --report goes before"));
  keys.push_back(
      switch_key("report.tracks", at(&A::report, &ReportConfig::tracks), "also write tracks.csv (the largest file)"));
  using O = RecordConfig;
  keys.push_back(text_key("record.directory", at(&A::record, &O::directory), {},
                          "record the run there, in LCM event logs: its messages, every point to the last bit, the "
                          "configuration; `hovermodal replay` gives the same estimates again; \"\" = none"));
  keys.push_back(whole_key("record.file_mb", "MB", at(&A::record, &O::file_mb), {1, 100000},
                           "a file that has grown to this is followed by the next"));
  keys.push_back(whole_key("record.quota_mb", "MB", at(&A::record, &O::quota_mb), {2, 100000000},
                           "of all records in the folder: the oldest runs are removed to make room; when only this run "
                           "is left, it is recorded no further"));
  using P = StateConfig;
  keys.push_back(
      text_key("state.directory", at(&A::state, &P::directory), {},
               "folder (made where it is missing) where spectra and modes are kept against a loss of power; a run that "
               "finds a state of the same configuration and view there goes on with it; \"\" = none"));
  keys.push_back(number_key("state.period_s", "s", at(&A::state, &P::period_s), {0.1, 86400},
                            "of stream time between two such states: at most so much record is lost"));
  using R = RtConfig;
  keys.push_back(switch_key("rt.required", at(&A::rt, &R::required),
                            "refuse to run where priority or memory lock are denied (exit 4)"));
  keys.push_back(whole_key("rt.priority", "", at(&A::rt, &R::priority), {0, 90},
                           "SCHED_FIFO priority of capture, tracking, spectrum; 0 = ordinary threads"));
  const auto cpu = [&](const char* name, int R::*member, const char* meaning) {
    keys.push_back(whole_key(std::string("rt.") + name, "", at(&A::rt, member), {-1, 1023}, meaning));
  };
  cpu("capture_cpu", &R::capture_cpu, "CPU that capture is pinned to; -1 = any");
  cpu("tracking_cpu", &R::tracking_cpu, "CPU that tracking is pinned to; -1 = any");
  cpu("spectrum_cpu", &R::spectrum_cpu, "CPU that spectrum is pinned to; -1 = any");
  keys.push_back(number_key("rt.stall_s", "s", at(&A::rt, &R::stall_s), {0.5, 3600},
                            "a stage that stays in one step for longer is named in health, and the watchdog is no "
                            "longer fed; identification may take ten times as long"));
  keys.push_back(
      switch_key("rt.lock_memory", at(&A::rt, &R::lock_memory), "keep the service's memory from being paged out"));
  keys.push_back(switch_key("rt.thin_overload", at(&A::rt, &R::thin_overload),
                            "a live source that is too fast for tracking: keep every n-th frame at equal spacing, with "
                            "new spectra at the new rate; false: keep what finds room"));
  keys.push_back(
      whole_key("rt.frame_slots", "", at(&A::rt, &R::frame_slots), {2, 256}, "frames that may wait for tracking"));
  keys.push_back(whole_key("rt.sample_slots", "", at(&A::rt, &R::sample_slots), {2, 65536},
                           "samples that may wait for spectra and records"));
}

}  // namespace app
