#pragma once

#include <optional>
#include <vector>

#include "core/planning/camera_view.h"
#include "core/planning/fold_place.h"
#include "core/planning/ideal_shape.h"
#include "core/planning/noise_floor.h"

namespace core::planning {

inline constexpr std::size_t kMaxModes = 40;
inline constexpr double kLeastExposureGain = 0.7;  // smallest gain: below, the exposure attenuates a mode too much
inline constexpr double kSeenRatio = 10.0;         // 10 dB over the noise floor

struct PlannedMode {
  double frequency_hz = 0.0;
  double damping_ratio = 0.01;
  std::optional<double> rms_mm;  // expected, at the point of largest motion
  std::vector<double> shape;     // per region; empty = that of the ideal structure, with the mode's index as its number
};

struct PlanInput {
  StructureKind kind = StructureKind::kShearChain;
  LongAxis axis = LongAxis::kVertical;
  double length_mm = 0.0;          // height or span
  int n_floors = 6;                // of a shear chain
  std::vector<double> positions;   // of the structure's regions, x / length; base excluded
  std::vector<PlannedMode> modes;  // by frequency
  double distance_mm = 0.0;
  PlannedCamera camera;
  double point_sigma_px = 0.03;
  int points_per_region = 30;
  double region_width_mm = 0.0, region_height_mm = 0.0;  // 0 = unknown
  double window_px = 21.0;
  double relative_sigma_frequency = 0.003;  // required
  double relative_sigma_damping = 0.2;
  double hover_s = 0.0;          // 0 = as long as the required sigmas need, within the battery
  double battery_s = 0.0;        // hover time of one battery; 0 = unknown
  std::vector<double> rates_hz;  // rates offered by the camera
};

// Default positions of regions: every floor; equal parts of a cantilever, the last at its top; equal parts of a beam
// between its supports.
[[nodiscard]] std::vector<double> even_positions(StructureKind kind, int n);

struct ModePlan {
  FoldPlace place;
  double half_power_hz = 0.0;  // 2 zeta f
  bool edge = false;
  bool in_hover_band = false;  // apparent frequency below kHoverBandHz
  double exposure_gain = 1.0;
  double least_rms_mm = 0.0;  // amplitude with a peak 10 dB above the noise floor
  std::optional<double> over_floor_db;
  double seconds_for_frequency = 0.0, seconds_for_damping = 0.0;        // for the required sigmas
  double relative_sigma_frequency = 0.0, relative_sigma_damping = 0.0;  // after hover_s
};

enum class Obstacle { kNone, kReadoutTooLong, kExposureTooLong };

// The given camera at another rate, perhaps rotated by 90 degrees.
struct CameraOption {
  double rate_hz = 0.0;
  bool turned = false;
  Obstacle obstacle = Obstacle::kNone;
  bool fits = true;
  int n_folded = 0, n_open = 0;  // modes above half the rate; modes with open alias order
  int n_overlaps = 0, n_merging = 0;
  int n_hidden = 0;  // aliased into the hover band or onto a band edge
  std::optional<double> least_margin;
  double penalty = 0.0;  // 3 open + 2 merging + 2 hidden + 1 other overlap + 1/4 folded; 10 if the image is too small
};

struct HoverPlan {
  double mm_per_px = 0.0;
  double structure_px = 0.0, room_px = 0.0;
  bool fits = true;                // within 90 % of the image
  double delay_span_frames = 0.0;  // of the regions, in frames
  double max_frequency_hz = 0.0;   // highest frequency to search: 1.1 times the highest mode, rounded up
  NoiseFloor floor;
  double needed_s = 0.0, hover_s = 0.0;
  int segment = 0;
  double bandwidth_hz = 0.0;  // of the segment's Hann window
  std::vector<ModePlan> modes;
  std::vector<Overlap> overlaps;
  std::vector<CameraOption> options;  // the given camera, rotated, then every other rate as held and rotated
  std::size_t best_option = 0;        // smallest penalty; of equals the one closest to the given camera
};

// Throws std::invalid_argument with the value and the allowed range.
void validate(const PlanInput& input);
[[nodiscard]] HoverPlan make_plan(const PlanInput& input);

}  // namespace core::planning
