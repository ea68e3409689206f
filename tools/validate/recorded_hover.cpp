#include "tools/validate/recorded_hover.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/simulation/camera/recorded_motion.h"
#include "core/simulation/random_stream.h"
#include "drivers/storage/flight_log.h"

namespace tools {
namespace {

using core::simulation::RecordedMotion;

constexpr double kSeedsPerRound = 20.0;

// The record starting at another instant, played back and forth, as long as needed.
std::vector<double> from_phase(const std::vector<double>& values, std::size_t first, std::size_t n) {
  std::vector<double> out;
  if (values.empty()) return out;
  const std::size_t round = 2 * (values.size() - 1);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = (first + k) % round;
    out.push_back(values[std::min(i, round - i)]);
  }
  return out;
}

}  // namespace

std::shared_ptr<const RecordedMotion> recorded_hover(const std::string& path, double scale, std::uint64_t seed,
                                                     double duration_s) {
  const core::FlightPath log = drivers::read_flight_path(path, kHoverFrom_s, kHoverTo_s);
  const RecordedMotion recorded =
      core::simulation::make_recorded_motion(log, nullptr, {log.mean_heading_deg, 0.0, 0.0});
  const auto round = 2 * (recorded.x_mm.size() - 1);
  const double within = core::simulation::RandomStream(seed, "flight_phase").uniform();
  const double share = std::fmod((static_cast<double>(seed - 1) + within) / kSeedsPerRound, 1.0);
  const auto first = static_cast<std::size_t>(std::llround(share * static_cast<double>(round)));
  const auto n = static_cast<std::size_t>(std::ceil((duration_s + 1.0) * recorded.rate_hz)) + 4;
  RecordedMotion out;
  out.rate_hz = recorded.rate_hz;
  for (auto axis : {&RecordedMotion::x_mm, &RecordedMotion::y_mm, &RecordedMotion::z_mm}) {
    out.*axis = from_phase(recorded.*axis, first, n);
    for (double& value : out.*axis) value *= scale;
  }
  return std::make_shared<const RecordedMotion>(std::move(out));
}

}  // namespace tools
