#pragma once

#include "core/rotors/aircraft.h"
#include "core/types/attitude.h"
#include "hovermodal/aircraft_t.hpp"
#include "hovermodal/attitude_t.hpp"

namespace drivers {

// What an autopilot states, to messages and back.

[[nodiscard]] hovermodal::attitude_t to_message(const core::AttitudeSample& sample);
[[nodiscard]] hovermodal::aircraft_t to_message(const core::AircraftState& state);

// False: no valid attitude (not finite, zero length).
[[nodiscard]] bool take_sample(const hovermodal::attitude_t& message, core::AttitudeSample& out) noexcept;
// False: more motors than AircraftState has. Values that cannot be become unknown.
[[nodiscard]] bool take_sample(const hovermodal::aircraft_t& message, core::AircraftState& out) noexcept;

}  // namespace drivers
