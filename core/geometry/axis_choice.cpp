// Axis of the regions from their motion (motion_axes.h).
#include <algorithm>
#include <cmath>

#include "core/geometry/motion_axes.h"

namespace core {

namespace {

constexpr double kAboveNoise = 4.0, kFarAboveNoise = 10.0;      // rms motion over rms noise
constexpr double kLeastMotion_px = 0.01;                        // the optics' own errors
constexpr double kOneDirection = 2.0, kOnlyOneDirection = 3.0;  // rms along over across
constexpr double kOfAll = 0.5;         // of the rms motion of all: a region with an axis of its own moves so much
constexpr double kUpright_deg = 15.0;  // u and v are what a structure filmed upright moves along
constexpr double kStep_deg = 5.0;      // coarse, so that rounding decides nothing

bool moves(const PlaneMotion& motion, double times) noexcept {
  const double most_px = motion.along_px(motion.principal_deg());
  return motion.n_samples > 0 && most_px > kLeastMotion_px && most_px > times * std::sqrt(motion.noise_px2);
}

// A region that hardly moves across has no more than its noise there.
bool is_one_direction(const PlaneMotion& motion, double ratio) noexcept {
  const double deg = motion.principal_deg();
  return motion.along_px(deg) > ratio * std::max(motion.across_px(deg), std::sqrt(motion.noise_px2));
}

double difference_deg(double a, double b) noexcept { return std::abs(std::remainder(a - b, 180.0)); }

// Right and down are positive.
double rounded_deg(double deg) noexcept {
  if (difference_deg(deg, 0.0) <= kUpright_deg) return 0.0;
  if (difference_deg(deg, 90.0) <= kUpright_deg) return 90.0;
  const double rounded = kStep_deg * std::round(deg / kStep_deg);
  return rounded <= -45.0 ? rounded + 180.0 : rounded;
}

PlaneMotion of_all(const MotionAxes& axes, const std::vector<Region>& regions) noexcept {
  PlaneMotion all;
  double n = 0.0;
  for (std::size_t r = 0; r < regions.size() && r < axes.n_regions(); ++r) {
    const PlaneMotion one = axes.motion(r);
    if (!makes_channel(regions[r].role) || one.n_samples == 0) continue;
    all.uu += one.uu, all.uv += one.uv, all.vv += one.vv, all.noise_px2 += one.noise_px2;
    all.n_samples += one.n_samples, n += 1.0;
  }
  if (n > 0.0) all.uu /= n, all.uv /= n, all.vv /= n, all.noise_px2 /= n;
  return all;
}

AxisChoice chosen(const PlaneMotion& motion) noexcept {
  if (!moves(motion, kAboveNoise)) return {};
  if (!is_one_direction(motion, kOneDirection)) return {AxisFrom::kMotion, 0.0, true};
  return {AxisFrom::kMotion, rounded_deg(motion.principal_deg()), false};
}

// Does it move across the common axis more than along it, or along one only where all together move along either?
// A region that moves as the reference does has next to no motion of its own: what is left of it says nothing.
bool has_own_axis(const PlaneMotion& motion, const AxisChoice& common, const PlaneMotion& all) noexcept {
  if (!moves(motion, kAboveNoise)) return false;
  if (common.from == AxisFrom::kMotion && common.both_axes) return is_one_direction(motion, kOnlyOneDirection);
  const double across_px = motion.across_px(common.axis_deg);
  return across_px > motion.along_px(common.axis_deg) && across_px > kOfAll * all.along_px(common.axis_deg);
}

}  // namespace

std::vector<AxisChoice> choose_axes(const MotionAxes& axes, const std::vector<Region>& regions) {
  const PlaneMotion all = of_all(axes, regions);
  const AxisChoice common = chosen(all);
  std::vector<AxisChoice> out;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const PlaneMotion motion = r < axes.n_regions() ? axes.motion(r) : PlaneMotion{};
    out.push_back(has_own_axis(motion, common, all) ? chosen(motion) : common);
  }
  return out;
}

bool is_axis_clear(const MotionAxes& axes, const std::vector<Region>& regions) {
  const PlaneMotion all = of_all(axes, regions);
  return moves(all, kFarAboveNoise) && is_one_direction(all, kOnlyOneDirection);
}

}  // namespace core
