#include "drivers/host/host_status.h"

#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "drivers/host/system_value.h"

namespace drivers {

namespace {

namespace fs = std::filesystem;

double hottest_c(const fs::path& root) {
  double hottest = std::numeric_limits<double>::quiet_NaN();
  for (const fs::path& zone : system_entries(root / "sys/class/thermal", "thermal_zone")) {
    const auto milli = system_number(zone / "temp");
    if (milli) hottest = std::fmax(hottest, *milli * 1e-3);  // fmax prefers a number to NaN
  }
  return hottest;
}

double mean_frequency_mhz(const fs::path& root) {
  double sum = 0.0;
  int n = 0;
  for (const fs::path& cpu : system_entries(root / "sys/devices/system/cpu", "cpu")) {
    if (const auto khz = system_number(cpu / "cpufreq/scaling_cur_freq")) sum += *khz * 1e-3, ++n;
  }
  return n > 0 ? sum / n : std::numeric_limits<double>::quiet_NaN();
}

int throttled(const fs::path& root) {
  const std::string firmware = system_line(root / "sys/devices/platform/soc/soc:firmware/get_throttled");
  if (!firmware.empty()) return (std::strtoul(firmware.c_str(), nullptr, 16) & 0xFU) != 0 ? 1 : 0;
  int known = -1;
  for (const fs::path& device : system_entries(root / "sys/class/thermal", "cooling_device")) {
    const std::string type = system_line(device / "type");
    if (type.find("cpufreq") == std::string::npos && type != "Processor") continue;
    if (const auto state = system_number(device / "cur_state")) known = std::max(known, *state > 0.0 ? 1 : 0);
  }
  return known;
}

// "MemAvailable:  123 kB"
std::int64_t memory_bytes(const fs::path& root, const std::string& key) {
  std::ifstream in(root / "proc/meminfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(key)) return std::strtoll(line.c_str() + key.size(), nullptr, 10) * 1024;
  }
  return -1;
}

std::int64_t resident_bytes(const fs::path& root) {
  std::ifstream in(root / "proc/self/statm");
  std::int64_t total_pages = 0, resident_pages = 0;
  if (!(in >> total_pages >> resident_pages)) return -1;
  return resident_pages * sysconf(_SC_PAGESIZE);
}

struct Disk {
  std::int64_t left_bytes = -1, bytes = -1;
};
Disk disk_of(const std::string& path) {
  struct statvfs disk {};
  if (statvfs(path.empty() ? "." : path.c_str(), &disk) != 0) return {};
  const auto block_bytes = static_cast<std::int64_t>(disk.f_frsize);
  return {static_cast<std::int64_t>(disk.f_bavail) * block_bytes,
          static_cast<std::int64_t>(disk.f_blocks) * block_bytes};
}

}  // namespace

core::HostHealth read_host_status(const std::string& disk_path, const std::string& root_path) {
  const fs::path root = root_path.empty() ? "/" : root_path;
  core::HostHealth host;
  host.cpu_temperature_c = hottest_c(root);
  host.cpu_frequency_mhz = mean_frequency_mhz(root);
  host.throttled = throttled(root);
  host.resident_bytes = resident_bytes(root);
  host.available_bytes = memory_bytes(root, "MemAvailable:");
  host.disk_left_bytes = disk_of(disk_path).left_bytes;
  return host;
}

HostCapacity read_host_capacity(const std::string& disk_path, const std::string& root_path) {
  return {memory_bytes(root_path.empty() ? "/" : root_path, "MemTotal:"), disk_of(disk_path).bytes};
}

// "cpu  USER NICE SYSTEM IDLE IOWAIT IRQ SOFTIRQ STEAL ..." in ticks since the start.
double ProcessorLoad::next() {
  std::istringstream in(system_line(fs::path(root_.empty() ? "/" : root_) / "proc/stat"));
  std::string name;
  in >> name;
  std::int64_t all = 0, idle = 0, ticks = 0;
  int i = 0;
  for (; i < 8 && in >> ticks; ++i) {
    all += ticks;
    if (i == 3 || i == 4) idle += ticks;
  }
  const std::int64_t worked = all - idle;
  const bool is_known = name == "cpu" && i >= 4;
  const double share = is_known && all_ >= 0 && all > all_
                           ? static_cast<double>(worked - worked_) / static_cast<double>(all - all_)
                           : std::numeric_limits<double>::quiet_NaN();
  worked_ = worked, all_ = is_known ? all : -1;
  return share;
}

}  // namespace drivers
