// Every check of hovermodal-validate: references that the simulator does not use itself (first-order theory,
// statistics, other trackers), the identification and the search for missing effects against the simulator's truth.
#include "tools/validate/checks.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "tools/validate/closure_series_tracked.h"
#include "tools/validate/closure_tracks.h"
#include "tools/validate/footage.h"
#include "tools/validate/geometry.h"
#include "tools/validate/identification.h"
#include "tools/validate/lines_beside_modes.h"
#include "tools/validate/peaks.h"
#include "tools/validate/render.h"
#include "tools/validate/signatures.h"
#include "tools/validate/structures.h"
#include "tools/validate/trust.h"
#include "tools/validate/years_of_flights.h"

namespace tools {
namespace {

using Options = ValidateOptions;

void print_signatures(const Options& options) {
  fmt::print("# effect: tracks with it minus tracks without it, rms; what the first-order signature leaves of it\n");
  for (const SignatureCheck& check : check_signatures(options.seed())) {
    fmt::print("signature\t{}\t{:.4f} px\t{:.5f} %\n", check.effect, check.rms_px, 1e2 * check.relative_error);
  }
}

void print_peaks(const Options& options) {
  const PeakCheck check = check_peaks(options.n_seeds, 600.0, options.first_seed);
  const auto print = [](const char* what, const ModePeak& mode, double value, double scatter,
                        const PeakErrors& errors) {
    fmt::print("peak\t{:.3f} Hz\t{}\t{:.5f}\t{:.5f}\t{:+.2f}\t{:.2f}\t{:+.2f}\n", mode.frequency_hz, what, value,
               scatter, errors.mean, errors.rms, errors.worst);
  };
  fmt::print("# {} seeds of {:.0f} s; errors in units of the theoretical scatter: mean, rms, worst\n", check.n_seeds,
             check.duration_s);
  fmt::print("# bars: |mean| <= {:.2f}, rms {:.2f} ... {:.2f}\n", check.most_mean, check.least_rms, check.most_rms);
  for (const ModePeak& mode : check.modes) {
    print("frequency_hz", mode, mode.frequency_hz, mode.frequency_scatter_hz, mode.frequency);
    print("damping_ratio", mode, mode.damping_ratio, mode.damping_scatter, mode.damping);
  }
  fmt::print("peaks\t{}\n", check.passed() ? "within the bars" : "OUTSIDE the bars");
}

void print_shifts(const Options& options) {
  fmt::print("# plates shifted by known parts of a pixel, drawn and measured again: worst, rms, shifts\n");
  for (const ShiftError& error : check_known_shifts(options.seed())) {
    fmt::print("shift\t{}\t{:.6f} px\t{:.6f} px\t{}\n", error.name, error.worst_px, error.rms_px, error.n_shifts);
  }
}

void print_pixels(const Options& options) {
  fmt::print(
      "# light of pixels less the same by brute force, grey levels (edges: of a step of 100): worst, rms, pixels\n");
  for (const ReferenceError& error : check_reference_pixels(options.seed())) {
    fmt::print("pixels\t{}\t{:.4f}\t{:.4f}\t{}\n", error.name, error.worst, error.rms, error.n_pixels);
  }
  fmt::print("# mean of each row under flickering lamps over that without, less the lamps' own: worst\n");
  fmt::print("flicker\t{:.5f}\n", check_flicker_bands(options.seed()));
}

void print_klt(const Options& options) { print_klt_errors(options.seed(), options.n_frames); }
void print_speed(const Options& options) { print_render_speed(options.seed(), options.n_threads); }

// The identification on simulated records.
template <void (*print)(const IdentificationOptions&)>
void identification(const Options& options) {
  print({options.n_seeds, options.n_threads, options.first_seed, options.flight});
}

// The whole chain after the tracker on simulated flights.
template <void (*print)(const GeometryOptions&), bool is_drawn = false>
void geometry(const Options& options) {
  print({options.n_seeds, options.n_threads, options.first_seed, options.duration_s, options.report, options.flight,
         is_drawn});
}

// Disturbances of real footage.
template <void (*print)(const FootageOptions&)>
void footage(const Options& options) {
  print({options.n_seeds, options.n_threads, options.first_seed});
}

// Residual diagnosis of tracks.
template <void (*print)(const ClosureTracksOptions&)>
void closure_tracks(const Options& options) {
  print({options.n_seeds, options.n_threads, options.duration_s, options.first_seed, options.effect, options.strength,
         options.flight});
}

void structures(const Options& o) { print_structures(o.what, o.n_seeds, o.n_threads, o.first_seed, o.report); }

template <void (*write)(const ChangesOptions&)>
void changes(const Options& o) {
  if (o.report.empty()) throw std::invalid_argument(o.what + ": --report names the folder for the flights");
  write({o.n_seeds, o.n_threads, o.first_seed, o.strength, o.report});
}

constexpr std::array kChecks{
    Check{"structure-kinds", "structural models against closed forms and dense matrices", structures, 0},
    Check{"structure-effects", "effects named in structures of every kind", structures, kRecords},
    Check{"structure-where", "which of ten storeys or elements lost stiffness", structures, kRecords},
    Check{"structure-tension", "tension of stay cables filmed at 50 frames/s", structures, kRecords},
    Check{"structure-large", "files of a wall of 10^5 degrees of freedom, in --report", structures, kSeed | kReport},
    Check{"signatures", "every effect's motion of the tracks against its linear signature", print_signatures, kSeed},
    Check{"peaks", "the true motion's frequencies and damping against those declared", print_peaks, kSeed | kSeeds},
    Check{"shifts", "plates drawn at known shifts, measured again", print_shifts, kSeed},
    Check{"pixels", "light of single pixels against brute force, flicker against the lamps'", print_pixels, kSeed},
    Check{"klt", "OpenCV's tracker in drawn frames against the true tracks", print_klt, kSeed | kFrames},
    Check{"speed", "1080p frames drawn per second", print_speed, kSeed | kThreads},
    Check{"bias", "bias, scatter and stated intervals of the identification", identification<print_bias>, kRecords},
    Check{"losses", "what random losses of samples and frames do to the modes", identification<print_losses>, kRecords},
    Check{"folding", "modes above half the frame rate", identification<print_folding>, kRecords},
    Check{"null", "a rigid building under a hovering camera: no mode", identification<print_null>, kRecords | kFlight},
    Check{"harmonics", "rotor lines and steady forces beside modes", identification<print_harmonics>, kRecords},
    Check{"closure", "closing the loop on structures that lack one known effect", identification<print_closure>,
          kRecords},
    Check{"closure-series", "closing the loop on two minutes of channels with one effect",
          identification<print_closure_series>, kRecords},
    Check{"closure-series-outside", "the same with that effect taken out of the catalogue",
          identification<print_closure_series_outside>, kRecords},
    Check{"closure-series-null", "and on channels without any", identification<print_closure_series_null>, kRecords},
    Check{"closure-series-tracked", "the same on displacements measured from tracks, with row delays",
          closure_tracks<print_closure_series_tracked>, kRecords | kEffect},
    Check{"closure-series-tracked-null", "and on such without any, from flights of many kinds",
          closure_tracks<print_closure_series_tracked_null>, kRecords},
    Check{"closure-null", "closing the loop on a structure that lacks none", identification<print_closure_null>,
          kRecords},
    Check{"closure-tracks", "closing the loop on tracks with an undeclared effect",
          closure_tracks<print_closure_tracks>, kRecords | kDuration | kEffect | kStrength},
    Check{"closure-tracks-pairs", "the same with two of them", closure_tracks<print_closure_tracks_pairs>,
          kRecords | kDuration | kStrength},
    Check{"closure-tracks-null", "closing the loop on tracks without one", closure_tracks<print_closure_tracks_null>,
          kRecords | kDuration},
    Check{"closure-tracks-outside", "the same with that effect taken out of the catalogue",
          closure_tracks<print_closure_tracks_outside>, kRecords | kDuration | kEffect | kStrength},
    Check{"closure-tracks-foreign-null", "closing the loop on tracks that are foreign to the model, without an effect",
          closure_tracks<print_closure_tracks_foreign_null>, kFlights},
    Check{"closure-tracks-foreign", "the same with an undeclared effect of real records",
          closure_tracks<print_closure_tracks_foreign>, kFlights | kEffect | kStrength},
    Check{"closure-tracks-foreign-sets", "the same with two of them (odd seeds) or three",
          closure_tracks<print_closure_tracks_foreign_sets>, kFlights | kStrength},
    Check{"closure-tracks-foreign-outside", "the same with an effect that is taken out of the catalogue",
          closure_tracks<print_closure_tracks_foreign_outside>, kFlights | kEffect | kStrength},
    Check{"closure-clip", "one drawn scene with an undeclared effect, as a file for simulate --scene",
          closure_tracks<print_closure_clip>, kSeed | kDuration | kEffect},
    Check{"closure-clip-foreign", "one scene that is foreign to the model, likewise; for small pictures",
          closure_tracks<print_closure_clip_foreign>, kSeed | kDuration | kEffect | kStrength | kFlight},
    Check{"closure-live", "effects that begin in mid-flight, taken out while the record runs",
          closure_tracks<print_closure_live>, kRecords | kDuration | kEffect | kStrength},
    Check{"closure-live-null", "the same on records without one", closure_tracks<print_closure_live_null>, kFlights},
    Check{"footage-covered", "a floor covered from some frame on", footage<print_covered>, kRecords},
    Check{"footage-glitches", "single frames in which a region was tracked wrongly", footage<print_glitches>, kRecords},
    Check{"footage-short", "records of a few cycles, and pure noise: what is called a mode", footage<print_short>,
          kRecords},
    Check{"readout", "readout time estimated from tracks", geometry<print_readout>, kRecords},
    Check{"readout-drawn", "the same with camera, structure and noise drawn", geometry<print_readout, true>, kRecords},
    Check{"geometry", "the paper's experiment, one correction after the other", geometry<print_geometry>, kFlights},
    Check{"geometry-drawn", "the same with camera, structure and noise drawn", geometry<print_geometry, true>,
          kFlights},
    Check{"geometry-pixels", "the paper's experiment from rendered clips through the service",
          geometry<print_geometry_pixels>, kFlights | kReport},
    Check{"geometry-pixels-drawn", "the same with camera, structure and noise drawn",
          geometry<print_geometry_pixels, true>, kFlights | kReport},
    Check{"trust-modes", "every mode of a record, and the intervals stated", geometry<print_trust_modes>, kFlights},
    Check{"trust-disturbed", "the same with lost frames, and under a camera that vibrates",
          geometry<print_trust_disturbed>, kFlights},
    Check{"trust-camera", "the modes of a record under a shaking camera, beside those under a still one",
          geometry<print_trust_camera>, kFlights},
    Check{"trust-lines", "lines of a machine beside a mode, and of the rotors", geometry<print_lines_beside_modes>,
          kFlights},
    Check{"trust-losses", "the modes of a record that losses of frames hide", geometry<print_trust_losses>,
          kRecords | kDuration},
    Check{"changes-flights", "thirty flights over two years, one storey loses --strength of its stiffness; in --report",
          changes<write_changing_flights>, kRecords | kStrength | kReport},
    Check{"changes-clock", "three flights, the clock of one is wrong; in --report", changes<write_clock_flights>,
          kRecords | kReport},
    Check{"paper", "the paper's experiment by its own chain, as published", geometry<print_paper>, kFlights},
    Check{"table1", "the paper's Table 1 and Figures 6 to 9, sensor by sensor", geometry<print_table1>,
          kFlights | kReport},
    Check{"wind", "gusts that turn the camera by 5 degrees", geometry<print_wind>, kFlights},
    Check{"wind-drawn", "the same with camera, structure and noise drawn", geometry<print_wind, true>, kFlights},
    Check{"low-frequency", "a mode of 0.32 Hz in the drift of the hover", geometry<print_low_frequency>, kFlights},
    Check{"low-frequency-drawn", "the same with camera, damping and noise drawn", geometry<print_low_frequency, true>,
          kFlights},
    Check{"deck", "a bridge deck, camera upright and turned", geometry<print_deck>, kFlights},
    Check{"deck-drawn", "the same with camera, damping and noise drawn", geometry<print_deck, true>, kFlights},
    Check{"elevation", "a tower seen from 30 degrees below", geometry<print_elevation>, kFlights},
    Check{"elevation-drawn", "the same with camera, structure and noise drawn", geometry<print_elevation, true>,
          kFlights},
    Check{"noise-floor", "nothing moves but the camera", geometry<print_noise_floor>, kFlights},
    Check{"noise-floor-drawn", "the same with camera, structure and noise drawn", geometry<print_noise_floor, true>,
          kFlights}};

}  // namespace

std::span<const Check> all_checks() noexcept { return kChecks; }

}  // namespace tools
