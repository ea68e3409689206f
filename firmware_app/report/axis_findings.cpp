#include "firmware_app/report/axis_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "firmware_app/config/region_axis.h"

namespace app {
namespace {

constexpr double kMoreAcross = 1.5;  // times the motion along
constexpr double kAboveNoise = 4.0;  // rms over rms
constexpr double kOfLargest = 0.3;   // of the motion of the region that moves most
constexpr double kMostTold = 100.0;  // largest reported ratio

double largest_px(const core::PlaneMotion& motion) { return motion.along_px(motion.principal_deg()); }

double most_of_all_px(const std::vector<core::Region>& regions, const core::MotionAxes& axes) {
  double most = 0.0;
  for (std::size_t r = 0; r < regions.size(); ++r)
    if (core::makes_channel(regions[r].role)) most = std::max(most, largest_px(axes.motion(r)));
  return most;
}

// Times the motion along the axis; 0: nothing to tell.
double times_across(const core::Region& region, const core::PlaneMotion& motion, double most_px) {
  if (!core::makes_channel(region.role) || region.both_axes || motion.n_samples == 0) return 0.0;
  const double noise_px = std::sqrt(motion.noise_px2), across = motion.across_px(region.axis_deg);
  if (across < std::max(kAboveNoise * noise_px, kOfLargest * most_px)) return 0.0;
  const double times = across / std::max({motion.along_px(region.axis_deg), noise_px, across / kMostTold});
  return times > kMoreAcross ? times : 0.0;
}

std::string axis_of_motion(const core::PlaneMotion& motion) {
  core::Region region;
  const double deg = motion.principal_deg();
  const bool is_upright = std::abs(std::remainder(deg - 90.0, 180.0)) <= 15.0;
  region.axis_deg = std::abs(deg) <= 15.0 ? 0.0 : is_upright ? 90.0 : 5.0 * std::round(deg / 5.0);
  return axis_words(region);
}

struct Group {
  std::vector<std::string> names;
  double most = 0.0;
};

}  // namespace

std::vector<std::string> motion_across_words(const std::vector<core::Region>& regions, const core::MotionAxes& axes) {
  std::map<std::pair<std::string, std::string>, Group> groups;  // axis, better axis
  const double most_px = most_of_all_px(regions, axes);
  for (std::size_t r = 0; r < regions.size() && r < axes.n_regions(); ++r) {
    const core::PlaneMotion motion = axes.motion(r);
    const double times = times_across(regions[r], motion, most_px);
    if (times == 0.0) continue;
    Group& group = groups[{axis_words(regions[r]), axis_of_motion(motion)}];
    group.names.push_back(regions[r].name);
    group.most = std::max(group.most, times);
  }
  std::vector<std::string> out;
  for (const auto& [axis, group] : groups) {
    out.push_back(
        fmt::format("{} moved across the axis {} up to {:.2g} times as much as along it, which is not "
                    "measured: set regions[].axis to {} or both",
                    fmt::join(group.names, ", "), axis.first, group.most, axis.second));
  }
  return out;
}

}  // namespace app
