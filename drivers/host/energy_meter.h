#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace drivers {

// Energy that the board measures of itself, from /sys below `root`: the processor packages' counters (RAPL), else the
// power sensors (INA219, INA226, INA260, INA3221 ...), of which an INA3221 states its first input, the board's.
// Counters are exact; power is integrated between calls of sample(). Reads a few small files: not for a real-time
// thread.
class EnergyMeter {
 public:
  explicit EnergyMeter(std::string root = "");

  // Call it at least once a second; a counter of a busy processor wraps within a minute. now_ns: any monotonic clock.
  void sample(std::int64_t now_ns);
  // Since the first sample. 0 where nothing measures it.
  [[nodiscard]] double joules() const noexcept { return joules_; }
  // What measures it, e.g. "RAPL package-0"; empty: nothing.
  [[nodiscard]] std::string source() const;
  // Why nothing measures it, with the remedy where there is one; empty: source() is not.
  [[nodiscard]] std::string why_not() const;

 private:
  struct Counter {
    std::string folder, name;
    double before_uj = 0.0, range_uj = 0.0;
  };
  struct Sensor {
    std::string power, voltage, current, name;  // files: power, or voltage and current
  };
  void find_counters();
  void find_sensors();
  [[nodiscard]] double power_w() const;  // of all sensors

  std::string root_;
  std::vector<Counter> counters_;
  std::vector<Sensor> sensors_;
  bool is_locked_ = false;  // a counter exists and cannot be read
  bool has_begun_ = false;
  std::int64_t before_ns_ = 0;
  double before_w_ = 0.0, joules_ = 0.0;
};

}  // namespace drivers
