#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/rotors/motor_lines.h"

namespace core {

// The aircraft in about one second of flight, as its autopilot states it. NaN: not known.
struct AircraftState {
  static constexpr std::size_t kMotors = 16;
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  double t_s = 0.0;                        // on the frames' clock
  std::array<double, kMotors> motor_hz{};  // turns per second of motor 1, 2, ...; 0: none, or it stands
  double latitude_deg = kUnknown, longitude_deg = kUnknown;
  double above_home_m = kUnknown;                        // where it took off
  double wind_m_s = kUnknown, wind_from_deg = kUnknown;  // clockwise from north
};

// States received since the previous frame.
struct AircraftBatch {
  static constexpr std::size_t kMost = 4;
  std::array<AircraftState, kMost> states{};
  std::uint32_t n = 0;
};

// A flight in a few numbers.
struct AircraftSummary {
  struct Place {
    double latitude_deg = 0.0, longitude_deg = 0.0;
    std::optional<double> above_home_m;
  };
  struct Wind {
    double m_s = 0.0, from_deg = 0.0;  // of the mean vector
  };
  std::uint64_t n_states = 0;
  std::vector<MotorRate> motors;  // those that turn
  std::optional<Place> place;     // mean
  std::optional<Wind> wind;

  [[nodiscard]] bool empty() const noexcept { return motors.empty() && !place && !wind; }
};

// The states of a flight, of fixed size: of each motor's rate the newest 1024 values, sums of the rest. One thread.
class AircraftLog {
 public:
  void add(const AircraftState& state) noexcept;
  [[nodiscard]] AircraftSummary summary() const;  // allocates
  [[nodiscard]] bool empty() const noexcept { return n_states_ == 0; }

 private:
  static constexpr std::size_t kRates = 1024;
  struct Motor {
    std::array<float, kRates> hz{};
    std::uint64_t n = 0;  // stored so far; the newest kRates are kept
  };

  std::uint64_t n_states_ = 0;
  std::array<Motor, AircraftState::kMotors> motors_{};
  double latitude_0_ = 0.0, longitude_0_ = 0.0;  // the first place: the sums are relative to it
  double latitude_sum_ = 0.0, longitude_sum_ = 0.0, above_sum_ = 0.0;
  std::uint64_t n_places_ = 0, n_above_ = 0;
  double wind_north_sum_ = 0.0, wind_east_sum_ = 0.0;  // where it comes from
  std::uint64_t n_winds_ = 0;
};

}  // namespace core
