#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/simulation/track_generator.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"
#include "firmware_app/config/config.h"
#include "tools/hovermodal/simulate/job.h"
#include "tools/validate/geometry.h"
#include "tools/validate/geometry_drawn.h"

namespace tools {

// One simulated flight, analysed several ways at once.

// How the operator declares the readout: as it is, not at all, or as filling the whole frame time (the paper's).
enum class StatedReadout : std::uint8_t { kTrue, kNone, kWholeFrame };

// One way to analyse the tracks: what differs from the configuration that `simulate` writes beside them.
struct Way {
  std::string name = "ours";
  std::vector<std::string> overrides = {};  // "section.key=value"
  StatedReadout readout = StatedReadout::kTrue;
  bool with_background = true;      // false: neither its region nor its points
  double attitude_sigma_deg = 0.0;  // an attitude with this noise is told as well; 0 = none
  bool plane_points = false;        // the corners of three plates are told in mm, each read to half a pixel
};

struct FlightSetup {
  std::string scene;                            // YAML, as drivers::parse_scene takes it
  std::vector<std::string> configuration = {};  // overrides for every way, the true motion's included
  double flight_scale = 0.0;  // the recorded flight moves the camera, its path times this; 0 = it does not
  bool ground_rests = false;  // and the operator says so, but for the paper's chain, which knows no such thing
  std::optional<DrawnFlight> drawn = {};  // in place of what `scene` says of camera, structure and noise
};
// Whether this build's configuration knows what is asked for, by the words of its help.
[[nodiscard]] bool configuration_knows(const std::string& words);

// The scene of one seed. A recorded flight moves its camera as recorded_hover() says; its attitude is the scene's own.
// Without a recording the path is the hover model's: 120, 40, 120 mm rms to the side, up and ahead, times flight_scale.
[[nodiscard]] SimulateJob flight_job(const FlightSetup& setup, std::uint64_t seed, double duration_s,
                                     const GeometryOptions& options);

// The overrides for every way of a job.
[[nodiscard]] std::vector<std::string> configuration_of(const SimulateJob& job, const FlightSetup& setup);

// What came of one way, beside the same identification on the true motion with the same prewhitening.
struct Analysed {
  core::ModalEstimate measured, truth;
  std::vector<core::ChannelInfo> channels;
  core::CpsdSums sums;
};

struct AnalysedFlight {
  std::vector<Analysed> ways;  // in the order asked for
  core::CpsdSums true_sums;
  double rate_hz = 0.0, duration_s = 0.0;
};
// Told every sample of every way, beside the true one.
using SampleObserver =
    std::function<void(std::size_t way, const core::DisplacementSample& sample, const core::DisplacementSample& truth)>;
// The true motion: displacement of the bodies (ground included) at the instant at which the middle of each region is
// read, averaged over the exposure; neither camera nor tracker in it (core::simulation::ChannelGenerator), but a
// hundredth of the tracker's noise.
[[nodiscard]] AnalysedFlight analyse_flight(const SimulateJob& job, const FlightSetup& setup,
                                            const std::vector<Way>& ways, const SampleObserver& observe = {});

// The true motion of a job alone, with a given prewhitening.
[[nodiscard]] core::ModalEstimate true_estimate(const SimulateJob& job, const FlightSetup& setup, int n_differences);

// The configuration of a way, and the camera as its operator declares it.
struct DeclaredRun {
  app::AppConfig config;
  core::CameraInfo camera;
};
[[nodiscard]] DeclaredRun declared_run(const SimulateJob& job, const FlightSetup& setup, const Way& way,
                                       const core::simulation::SceneMotion& motion);

}  // namespace tools
