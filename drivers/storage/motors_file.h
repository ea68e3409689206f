#pragma once

#include <string>
#include <vector>

#include "core/rotors/motor_lines.h"

namespace drivers {

// A CSV of the speeds of the aircraft's motors: t_s, motor (from 1), hz (turns per second), in any order; other columns
// are ignored, lines with `#` are comments. Each motor's median and standard deviation (from the median deviation, so
// that take-off and landing count little), of those that turn at 1 Hz or more. Throws FileError "FILE:LINE: ..." on
// a missing file or column, text in place of a number, and where no motor turns.
[[nodiscard]] std::vector<core::MotorRate> read_motors_csv(const std::string& path);

}  // namespace drivers
