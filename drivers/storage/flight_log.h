#pragma once

#include <string>

#include "core/types/flight_record.h"

namespace drivers {

// Positions from the CSV that tools make of a DJI flight log: columns time (milliseconds since the start), latitude,
// longitude, an altitude of the position solution (altitude_above_seaLevel, else altitude; metres or feet by its unit),
// compass_heading. Units in brackets, blanks and capitals in names are ignored.
// North and east by the radii of curvature of WGS 84 at the mean latitude.
// Throws std::invalid_argument and FileError as read_timed_columns does, and FileError if there is no position.
[[nodiscard]] core::FlightPath read_flight_path(const std::string& path, double from_s, double to_s);

// Angles and accelerations from the CSV of an inertial sensor: SampleTimeFine (microseconds), Euler_X, Euler_Y, Euler_Z
// (degrees), Acc_X, Acc_Y, Acc_Z (m/s^2, gravity included). Its first row is at `first_row_at_s` of the flight.
[[nodiscard]] core::FlightAttitude read_flight_attitude(const std::string& path, double first_row_at_s, double from_s,
                                                        double to_s);

}  // namespace drivers
