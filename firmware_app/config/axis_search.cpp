#include "firmware_app/config/axis_search.h"

#include "firmware_app/config/region_axis.h"

namespace app {
namespace {

constexpr double kFirstAsked_s = 4.0;

}  // namespace

AxisSearch::AxisSearch(const AppConfig& config, std::size_t n_points)
    : regions_(config.regions), axes_(config.regions, n_points), ask_s_(kFirstAsked_s) {}

bool AxisSearch::is_settled_by(const core::TrackFrame& frame) noexcept {
  axes_.add(frame);
  if (axes_.duration_s() >= kLongest_s) return true;
  if (axes_.duration_s() < ask_s_) return false;
  ask_s_ *= 2.0;
  return core::is_axis_clear(axes_, regions_);
}

void AxisSearch::take(AppConfig& config) const { take_axes(config, core::choose_axes(axes_, regions_)); }

}  // namespace app
