#include "drivers/host/energy_meter.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "drivers/host/system_value.h"

namespace drivers {

namespace fs = std::filesystem;

EnergyMeter::EnergyMeter(std::string root) : root_(root.empty() ? "/" : std::move(root)) {
  find_counters();
  if (counters_.empty()) find_sensors();
}

// Packages alone: a counter of a part of one (core, dram) would be counted twice.
void EnergyMeter::find_counters() {
  for (const fs::path& zone : system_entries(fs::path(root_) / "sys/class/powercap", "")) {
    const std::string name = system_line(zone / "name");
    if (!name.starts_with("package")) continue;
    const auto now = system_number(zone / "energy_uj"), range = system_number(zone / "max_energy_range_uj");
    is_locked_ = is_locked_ || !now;
    if (now) counters_.push_back({zone.string(), "RAPL " + name, *now, range.value_or(0.0)});
  }
  std::sort(counters_.begin(), counters_.end(), [](const Counter& a, const Counter& b) { return a.name < b.name; });
}

void EnergyMeter::find_sensors() {
  for (const fs::path& chip : system_entries(fs::path(root_) / "sys/class/hwmon", "hwmon")) {
    const std::string name = system_line(chip / "name");
    if (!name.starts_with("ina")) continue;
    if (system_number(chip / "power1_input")) {
      sensors_.push_back({(chip / "power1_input").string(), "", "", name});
    } else if (system_number(chip / "in1_input") && system_number(chip / "curr1_input")) {
      std::string named = name;
      if (const std::string label = system_line(chip / "in1_label"); !label.empty()) (named += ' ') += label;
      sensors_.push_back({"", (chip / "in1_input").string(), (chip / "curr1_input").string(), named});
    }
  }
}

double EnergyMeter::power_w() const {
  double sum = 0.0;
  for (const Sensor& sensor : sensors_) {
    sum += sensor.power.empty()
               ? 1e-6 * system_number(sensor.voltage).value_or(0.0) * system_number(sensor.current).value_or(0.0)
               : 1e-6 * system_number(sensor.power).value_or(0.0);
  }
  return sum;
}

void EnergyMeter::sample(std::int64_t now_ns) {
  for (Counter& counter : counters_) {
    const double now = system_number(fs::path(counter.folder) / "energy_uj").value_or(counter.before_uj);
    const double more = now - counter.before_uj;
    if (has_begun_) joules_ += 1e-6 * (more < 0.0 ? more + counter.range_uj : more);
    counter.before_uj = now;
  }
  if (!sensors_.empty()) {
    const double now_w = power_w();
    if (has_begun_) joules_ += 0.5e-9 * static_cast<double>(now_ns - before_ns_) * (now_w + before_w_);
    before_w_ = now_w;
  }
  before_ns_ = now_ns, has_begun_ = true;
}

std::string EnergyMeter::source() const {
  std::string out;
  for (const Counter& counter : counters_) out += (out.empty() ? "" : ", ") + counter.name;
  for (const Sensor& sensor : sensors_) out += (out.empty() ? "" : ", ") + sensor.name;
  return out;
}

std::string EnergyMeter::why_not() const {
  if (!counters_.empty() || !sensors_.empty()) return "";
  return is_locked_ ? "the processor's energy counter may be read by root alone; run this command as root"
                    : "this board measures no energy: neither RAPL nor an INA sensor in /sys";
}

}  // namespace drivers
