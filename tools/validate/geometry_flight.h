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

// One simulated flight, analysed in several ways.

// The declared readout: the true one, none, or the whole frame time (the paper's).
enum class StatedReadout : std::uint8_t { kTrue, kNone, kWholeFrame };

// One way to analyse the tracks: its differences from the configuration that `simulate` writes beside them.
struct Way {
  std::string name = "ours";
  std::vector<std::string> overrides = {};  // "section.key=value"
  StatedReadout readout = StatedReadout::kTrue;
  bool with_background = true;      // false: neither its region nor its points
  double attitude_sigma_deg = 0.0;  // an attitude with this noise is supplied; 0 = none
  bool plane_points = false;        // the corners of three plates are given in mm, each read to half a pixel
};

struct FlightSetup {
  std::string scene;                            // YAML, as drivers::parse_scene takes it
  std::vector<std::string> configuration = {};  // overrides for every way, and for the true motion
  double flight_scale = 0.0;  // the recorded flight moves the camera, its path multiplied by this; 0 = not used
  bool ground_rests = false;  // static ground, declared except for the paper's chain, which has no such declaration
  std::optional<DrawnFlight> drawn = {};  // replaces camera, structure and noise of `scene`
};
// Whether this build's configuration has the requested key, by the text of its help.
[[nodiscard]] bool configuration_knows(const std::string& words);

// The scene of one seed. A recorded flight moves its camera as in recorded_hover(); the attitude is the scene's own.
// Without a recording the path is the hover model's: 120, 40, 120 mm rms to the side, up and ahead, times flight_scale.
[[nodiscard]] SimulateJob flight_job(const FlightSetup& setup, std::uint64_t seed, double duration_s,
                                     const GeometryOptions& options);

// The overrides for every way of a job.
[[nodiscard]] std::vector<std::string> configuration_of(const SimulateJob& job, const FlightSetup& setup);

// Result of one way, with the identification of the true motion by the same prewhitening.
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
// Receives every sample of every way, with the true one.
using SampleObserver =
    std::function<void(std::size_t way, const core::DisplacementSample& sample, const core::DisplacementSample& truth)>;
// The true motion: displacement of the bodies (ground included) at the instant at which the middle of each region is
// read, averaged over the exposure; without camera and tracker (core::simulation::ChannelGenerator), except for a
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
