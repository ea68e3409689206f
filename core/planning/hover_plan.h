#pragma once

#include <optional>
#include <vector>

#include "core/planning/camera_view.h"
#include "core/planning/fold_place.h"
#include "core/planning/ideal_shape.h"
#include "core/planning/noise_floor.h"

namespace core::planning {

inline constexpr std::size_t kMaxModes = 40;
inline constexpr double kLeastExposureGain = 0.7;  // below it the exposure attenuates a mode too much
inline constexpr double kSeenRatio = 10.0;         // 10 dB over the noise floor

struct PlannedMode {
  double frequency_hz = 0.0;
  double damping_ratio = 0.01;
  std::optional<double> rms_mm;  // expected, where the mode moves most
  std::vector<double> shape;     // per region; empty = of the ideal structure, the mode's place in the list its number
};

struct PlanInput {
  StructureKind kind = StructureKind::kShearChain;
  LongAxis axis = LongAxis::kVertical;
  double length_mm = 0.0;          // height or span
  int n_floors = 6;                // of a shear chain
  std::vector<double> positions;   // of the structure's regions, x / length; the base is none of them
  std::vector<PlannedMode> modes;  // by frequency
  double distance_mm = 0.0;
  PlannedCamera camera;
  double point_sigma_px = 0.03;
  int points_per_region = 30;
  double region_width_mm = 0.0, region_height_mm = 0.0;  // 0 = unknown
  double window_px = 21.0;
  double relative_sigma_frequency = 0.003;  // wanted
  double relative_sigma_damping = 0.2;
  double hover_s = 0.0;          // 0 = as long as the wanted sigmas need, within the battery
  double battery_s = 0.0;        // hover time of one battery; 0 = unknown
  std::vector<double> rates_hz;  // that the camera offers
};

// Default placement of regions: every floor; even parts of a cantilever, its top the last; even parts of a beam between
// its supports.
[[nodiscard]] std::vector<double> even_positions(StructureKind kind, int n);

struct ModePlan {
  FoldPlace place;
  double half_power_hz = 0.0;  // 2 zeta f
  bool edge = false;
  bool in_hover_band = false;  // seen below kHoverBandHz
  double exposure_gain = 1.0;
  double least_rms_mm = 0.0;  // seen at 10 dB over the floor
  std::optional<double> over_floor_db;
  double seconds_for_frequency = 0.0, seconds_for_damping = 0.0;        // for the wanted sigmas
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
  int n_hidden = 0;  // aliased into the hover band, or onto an edge
  std::optional<double> least_margin;
  double penalty = 0.0;  // 3 open + 2 merging + 2 hidden + 1 other overlap + 1/4 folded; 10 where it does not fit
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
  std::vector<CameraOption> options;  // the given camera, turned, then every other rate as held and turned
  std::size_t best_option = 0;        // smallest penalty; of equals the one closest to the given camera
};

// Throws std::invalid_argument with the value and the allowed range.
void validate(const PlanInput& input);
[[nodiscard]] HoverPlan make_plan(const PlanInput& input);

}  // namespace core::planning
