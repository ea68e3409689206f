#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/types/closure_result.h"
#include "core/types/modal_estimate.h"

namespace core {

// How fast a motor of the aircraft turned during a flight.
struct MotorRate {
  int number = 0;          // 1, 2, ...
  double hz = 0.0;         // turns per second, median
  double spread_hz = 0.0;  // standard deviation
};

// Speeds outside these are none of a flying motor's.
inline constexpr double kLeastTurns_hz = 1.0, kMostTurns_hz = 2000.0;

// Median of the speeds, and the standard deviation from their median deviation, so that take-off and landing count
// little. hz: not empty.
[[nodiscard]] MotorRate motor_rate(int number, std::vector<double> hz);

// A vibration at a multiple of a motor's rate, as the samples show it.
struct MotorLine {
  MotorRate motor;
  int multiple = 1;          // 1: imbalance; 2, 3: passing blades
  double apparent_hz = 0.0;  // 0 .. rate / 2
  double width_hz = 0.0;  // half: two standard deviations of the motor's rate, its tachometer's error, the resolution
};

// Where the motors of the aircraft may cause lines in a spectrum. Plain values; any thread.
class MotorLines {
 public:
  MotorLines() = default;  // no motor is known
  explicit MotorLines(std::vector<MotorRate> motors) : motors_(std::move(motors)) {}

  [[nodiscard]] bool empty() const noexcept { return motors_.empty(); }
  // The nearest line in whose width this frequency lies. rate_hz: of the samples; resolution_hz: of the spectrum.
  [[nodiscard]] std::optional<MotorLine> at(double apparent_hz, double rate_hz, double resolution_hz) const;

  // A mode at the line of a motor whose shape, at that motor's frequency, is a camera's vibration (a translation and a
  // slope over the rows) becomes camera motion. Others stay: the lines of four motors cover a quarter of the band, and
  // a mode lies in one by chance; where the row delays cannot tell, the reason names the motor. So does that of a pole
  // in a line that is no mode, unless it is numerical. delay_s: of each channel, as the shapes are corrected for.
  void judge(ModalEstimate& estimate, const std::vector<double>& delay_s) const;
  // Adds the motor to the meaning of an adopted rotor line.
  void name(closure::ClosureResult& result, double rate_hz, double duration_s) const;

 private:
  [[nodiscard]] std::vector<MotorLine> lines(double rate_hz, double resolution_hz) const;

  std::vector<MotorRate> motors_;
};

// "twice the rate of motor 3, 95.21 +- 0.04 Hz, appears at 9.58 Hz"
[[nodiscard]] std::string words_of(const MotorLine& line);

}  // namespace core
