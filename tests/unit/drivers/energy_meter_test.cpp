#include "drivers/host/energy_meter.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/test_clip.h"

namespace drivers {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

void put(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

void put_zone(const fs::path& root, const std::string& zone, const std::string& name, const std::string& energy_uj) {
  put(root / "sys/class/powercap" / zone / "name", name + "\n");
  put(root / "sys/class/powercap" / zone / "max_energy_range_uj", "1000000000\n");
  put(root / "sys/class/powercap" / zone / "energy_uj", energy_uj + "\n");
}

TEST(EnergyMeter, AddsUpThePackagesAndNotTheirParts) {
  const fs::path root = test_support::fresh_folder();
  put_zone(root, "intel-rapl:0", "package-0", "1000000");
  put_zone(root, "intel-rapl:0:0", "core", "500000");
  put_zone(root, "intel-rapl:1", "package-1", "999000000");
  EnergyMeter meter(root.string());
  EXPECT_EQ(meter.source(), "RAPL package-0, RAPL package-1");
  EXPECT_EQ(meter.why_not(), "");
  meter.sample(0);
  EXPECT_DOUBLE_EQ(meter.joules(), 0.0);
  put_zone(root, "intel-rapl:0", "package-0", "4000000");
  put_zone(root, "intel-rapl:0:0", "core", "2500000");
  put_zone(root, "intel-rapl:1", "package-1", "1000000");  // wrapped: 1 J to the end of its range, 1 J beyond
  meter.sample(kSecond_ns);
  EXPECT_DOUBLE_EQ(meter.joules(), 3.0 + 2.0);
}

TEST(EnergyMeter, IntegratesThePowerOfASensor) {
  const fs::path root = test_support::fresh_folder();
  const fs::path chip = root / "sys/class/hwmon/hwmon3";
  put(chip / "name", "ina226\n");
  put(chip / "power1_input", "4000000\n");
  put(root / "sys/class/hwmon/hwmon0/name", "cpu_thermal\n");
  put(root / "sys/class/hwmon/hwmon0/power1_input", "99000000\n");
  EnergyMeter meter(root.string());
  EXPECT_EQ(meter.source(), "ina226");
  meter.sample(10 * kSecond_ns);
  put(chip / "power1_input", "6000000\n");
  meter.sample(12 * kSecond_ns);
  EXPECT_DOUBLE_EQ(meter.joules(), 10.0);
}

TEST(EnergyMeter, TakesVoltageTimesCurrentOfTheBoardsInput) {
  const fs::path root = test_support::fresh_folder();
  const fs::path chip = root / "sys/class/hwmon/hwmon1";
  put(chip / "name", "ina3221\n");
  put(chip / "in1_label", "VDD_IN\n");
  put(chip / "in1_input", "5000\n");    // mV
  put(chip / "curr1_input", "1200\n");  // mA
  put(chip / "in2_input", "900\n");
  put(chip / "curr2_input", "400\n");
  EnergyMeter meter(root.string());
  EXPECT_EQ(meter.source(), "ina3221 VDD_IN");
  meter.sample(0);
  meter.sample(kSecond_ns);
  EXPECT_DOUBLE_EQ(meter.joules(), 6.0);
}

TEST(EnergyMeter, SaysWhyNothingIsKnown) {
  const fs::path root = test_support::fresh_folder();
  EnergyMeter none(root.string());
  none.sample(0);
  none.sample(kSecond_ns);
  EXPECT_DOUBLE_EQ(none.joules(), 0.0);
  EXPECT_EQ(none.source(), "");
  EXPECT_NE(none.why_not().find("neither RAPL nor an INA sensor"), std::string::npos);
  put(root / "sys/class/powercap/intel-rapl:0/name", "package-0\n");  // its counter cannot be read
  EXPECT_NE(EnergyMeter(root.string()).why_not().find("as root"), std::string::npos);
}

}  // namespace
}  // namespace drivers
