#include "core/rotors/aircraft.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace core {

namespace {

constexpr double kRad = std::numbers::pi / 180.0;

// The same angle within half a turn of 0.
double wrapped_deg(double angle) noexcept { return std::remainder(angle, 360.0); }

}  // namespace

void AircraftLog::add(const AircraftState& state) noexcept {
  ++n_states_;
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const double hz = state.motor_hz[i];
    if (!(hz >= kLeastTurns_hz && hz <= kMostTurns_hz)) continue;
    motors_[i].hz[motors_[i].n++ % kRates] = static_cast<float>(hz);
  }
  if (std::abs(state.latitude_deg) <= 90.0 && std::abs(state.longitude_deg) <= 360.0) {
    if (n_places_ == 0) latitude_0_ = state.latitude_deg, longitude_0_ = state.longitude_deg;
    latitude_sum_ += state.latitude_deg - latitude_0_;
    longitude_sum_ += wrapped_deg(state.longitude_deg - longitude_0_);
    ++n_places_;
  }
  if (std::isfinite(state.above_home_m)) above_sum_ += state.above_home_m, ++n_above_;
  if (std::isfinite(state.wind_m_s) && std::isfinite(state.wind_from_deg)) {
    wind_north_sum_ += state.wind_m_s * std::cos(kRad * state.wind_from_deg);
    wind_east_sum_ += state.wind_m_s * std::sin(kRad * state.wind_from_deg);
    ++n_winds_;
  }
}

AircraftSummary AircraftLog::summary() const {
  AircraftSummary out;
  out.n_states = n_states_;
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const auto n = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(motors_[i].n, kRates));
    if (n == 0) continue;
    out.motors.push_back(
        motor_rate(static_cast<int>(i) + 1, std::vector<double>(motors_[i].hz.begin(), motors_[i].hz.begin() + n)));
  }
  if (n_places_ > 0) {
    const auto n = static_cast<double>(n_places_);
    out.place = AircraftSummary::Place{latitude_0_ + latitude_sum_ / n, wrapped_deg(longitude_0_ + longitude_sum_ / n),
                                       std::nullopt};
    if (n_above_ > 0) out.place->above_home_m = above_sum_ / static_cast<double>(n_above_);
  }
  if (n_winds_ > 0) {
    const auto n = static_cast<double>(n_winds_);
    const double from = std::atan2(wind_east_sum_, wind_north_sum_) / kRad;
    out.wind = AircraftSummary::Wind{std::hypot(wind_north_sum_, wind_east_sum_) / n, from < 0.0 ? from + 360.0 : from};
  }
  return out;
}

}  // namespace core
