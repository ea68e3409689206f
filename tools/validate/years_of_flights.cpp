// Flights over two years, for `hovermodal changes`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/simulation/structure/structure_builders.h"
#include "core/types/constants.h"
#include "drivers/storage/json.h"
#include "firmware_app/report/modal_json.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/identification_record.h"
#include "tools/validate/identification_scene.h"
#include "tools/validate/years_of_flights.h"

namespace tools {
namespace {

namespace fs = std::filesystem;

constexpr int kFlights = 30, kFirstAfter = 15;  // flight 16
constexpr double kFlight_s = 120.0, kFlightRate_hz = 30.0, kYear_days = 365.25;
constexpr double kMostKelvin = 10.0;

// What one seed draws of the structure.
struct Subject {
  core::simulation::ShearBuilding frame;
  std::vector<double> damping;
  std::size_t weak_storey = 0;
  // Stiffness over that at the mean temperature: 1 - a T - b T^2, T in kelvin from the mean. Not the linear course that
  // the test fits.
  double a = 0.0, b = 0.0;

  explicit Subject(std::uint64_t seed) {
    Draw draw(seed, "changing_structure");
    const int n = draw.whole(4, 6);
    const double first_hz = draw.uniform(0.8, 2.0);
    const double unit = std::pow(core::kTwoPi * first_hz / (2.0 * std::sin(core::kPi / (2.0 * (2 * n + 1)))), 2);
    for (int i = 0; i < n; ++i) {
      frame.mass_kg.push_back(1000.0 * draw.uniform(0.8, 1.2));
      frame.stiffness_n_per_m.push_back(1000.0 * unit * draw.uniform(0.8, 1.2));
      damping.push_back(draw.log_uniform(0.005, 0.02));
    }
    weak_storey = static_cast<std::size_t>(draw.whole(0, n - 1));
    a = draw.uniform(2e-4, 1.5e-3), b = draw.uniform(-2e-5, 2e-5);
  }

  [[nodiscard]] core::simulation::StructureModel at(double kelvin, double loss) const {
    core::simulation::ShearBuilding now = frame;
    for (double& k : now.stiffness_n_per_m) k *= 1.0 - a * kelvin - b * kelvin * kelvin;
    now.stiffness_n_per_m[weak_storey] *= 1.0 - loss;
    return core::simulation::shear_frame(now, core::simulation::ModalDamping{damping});
  }
};

struct FlownAt {
  double day = 0.0, kelvin = 0.0;
};

// clock: stated over true rate.
void fly(const Subject& subject, const FlownAt& at, double loss, double clock, std::uint64_t seed,
         const std::string& path) {
  StoreysSetup setup{.duration_s = kFlight_s, .rate_hz = kFlightRate_hz};
  setup.structure = subject.at(at.kelvin, loss);
  setup.frequency_hz.clear();
  for (const auto& mode : modes_of(*setup.structure)) setup.frequency_hz.push_back(mode.frequency_hz);
  Record record = structure_record(storeys_scene(setup, seed), true);
  record.rate_hz *= clock;
  app::ModalReport report;
  report.method = "hovermodal";
  for (const core::ChannelInfo& channel : record.channels) report.channel_names.push_back(channel.name);
  report.estimate = identify_record(record);
  report.estimate.poles.clear();
  drivers::write_file_atomically(path, app::modal_json(report));
}

// Seasons and weather, at most ten kelvin from the mean.
double kelvin_on(double day, double phase, Draw& weather) {
  const double season = 7.0 * std::sin(core::kTwoPi * (day / kYear_days + phase)), today = 2.5 * weather.gaussian();
  return std::clamp(season + today, -kMostKelvin, kMostKelvin);
}

std::uint64_t seed_of(std::uint64_t seed, int flight) { return 100 * seed + static_cast<std::uint64_t>(flight); }

std::string folder_of(const ChangesOptions& options, std::uint64_t seed) {
  const fs::path folder = fs::path(options.folder) / std::to_string(seed);
  fs::create_directories(folder);
  return folder.string();
}

int write_years(const ChangesOptions& options, std::uint64_t seed) {
  const Subject subject(seed);
  const std::string folder = folder_of(options, seed);
  Draw dates(seed, "flight_dates"), weather(seed, "flight_weather");
  const double phase = dates.uniform(0.0, 1.0);
  std::string table = "report,day,temperature_c\n";
  double day = 0.0;
  for (int f = 0; f < kFlights; ++f) {
    day += dates.uniform(10.0, 40.0);
    const FlownAt at{day, kelvin_on(day, phase, weather)};
    const std::string name = fmt::format("flight{:02}.json", f + 1);
    fly(subject, at, f >= kFirstAfter ? options.loss : 0.0, 1.0, seed_of(seed, f), folder + "/" + name);
    table += fmt::format("{},{:.2f},{:.2f}\n", name, at.day, 12.0 + at.kelvin);
  }
  drivers::write_file_atomically(folder + "/flights.csv", table);
  return 0;
}

// The number of the flight with the wrong clock.
int write_week(const ChangesOptions& options, std::uint64_t seed) {
  const Subject subject(seed);
  const std::string folder = folder_of(options, seed);
  Draw draw(seed, "flight_clock");
  const int wrong = draw.whole(1, 3);
  const double clock = 1.0 + draw.sign() * draw.log_uniform(0.005, 0.2);
  std::string table = "report,day\n";
  for (int f = 1; f <= 3; ++f) {
    const FlownAt at{2.0 * f, draw.uniform(-1.0, 1.0)};
    const std::string name = fmt::format("flight{}.json", f);
    fly(subject, at, 0.0, f == wrong ? clock : 1.0, seed_of(seed, f), folder + "/" + name);
    table += fmt::format("{},{:.2f}\n", name, at.day);
  }
  drivers::write_file_atomically(folder + "/flights.csv", table);
  return wrong;
}

}  // namespace

void write_changing_flights(const ChangesOptions& options) {
  (void)for_each_seed(options, [&](std::uint64_t seed) { return write_years(options, seed); });
}

void write_clock_flights(const ChangesOptions& options) {
  const auto wrong = for_each_seed(options, [&](std::uint64_t seed) { return write_week(options, seed); });
  for (std::size_t i = 0; i < wrong.size(); ++i)
    fmt::print("clock-flight\t{}\t{}\n", static_cast<std::size_t>(options.first_seed) + i, wrong[i]);
}

}  // namespace tools
