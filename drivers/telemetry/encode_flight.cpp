#include "drivers/telemetry/encode_flight.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace drivers {
namespace {

double within(double value, double least, double most) noexcept {
  return value >= least && value <= most ? value : core::AircraftState::kUnknown;
}

}  // namespace

hovermodal::attitude_t to_message(const core::AttitudeSample& sample) {
  hovermodal::attitude_t out{};
  out.time_ns = std::llround(1e9 * sample.t_s);
  std::copy(sample.wxyz.begin(), sample.wxyz.end(), std::begin(out.wxyz));
  return out;
}

hovermodal::aircraft_t to_message(const core::AircraftState& state) {
  hovermodal::aircraft_t out{};
  out.time_ns = std::llround(1e9 * state.t_s);
  out.latitude_deg = state.latitude_deg;
  out.longitude_deg = state.longitude_deg;
  out.above_home_m = state.above_home_m;
  out.wind_m_s = state.wind_m_s;
  out.wind_from_deg = state.wind_from_deg;
  const auto last = std::find_if(state.motor_hz.rbegin(), state.motor_hz.rend(), [](double hz) { return hz > 0.0; });
  out.motor_hz.assign(state.motor_hz.begin(), last.base());
  out.n_motors = static_cast<std::int16_t>(out.motor_hz.size());
  return out;
}

bool take_sample(const hovermodal::attitude_t& message, core::AttitudeSample& out) noexcept {
  double squares = 0.0;
  for (const double part : message.wxyz) squares += part * part;
  if (!(squares > 1e-6) || !(squares < 1e12)) return false;
  out.t_s = 1e-9 * static_cast<double>(message.time_ns);
  std::copy(std::begin(message.wxyz), std::end(message.wxyz), out.wxyz.begin());
  return true;
}

bool take_sample(const hovermodal::aircraft_t& message, core::AircraftState& out) noexcept {
  if (message.motor_hz.size() > out.motor_hz.size()) return false;
  out.t_s = 1e-9 * static_cast<double>(message.time_ns);
  out.latitude_deg = within(message.latitude_deg, -90.0, 90.0);
  out.longitude_deg = within(message.longitude_deg, -180.0, 360.0);
  out.above_home_m = within(message.above_home_m, -1e4, 1e5);
  out.wind_m_s = within(message.wind_m_s, 0.0, 200.0);
  out.wind_from_deg = within(message.wind_from_deg, -360.0, 360.0);
  out.motor_hz.fill(0.0);
  for (std::size_t i = 0; i < message.motor_hz.size(); ++i) {
    const double hz = message.motor_hz[i];
    if (hz >= core::kLeastTurns_hz && hz <= core::kMostTurns_hz) out.motor_hz[i] = hz;
  }
  return true;
}

}  // namespace drivers
