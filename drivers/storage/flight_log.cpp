#include "drivers/storage/flight_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/types/constants.h"
#include "drivers/storage/text_file.h"
#include "drivers/storage/timed_columns.h"

namespace drivers {
namespace {

using core::kRadPerDeg;
constexpr double kMetresPerFoot = 0.3048;

double mean(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

// (x - mean) * factor
std::vector<double> about_mean(const std::vector<double>& x, double factor) {
  const double centre = mean(x);
  std::vector<double> out;
  out.reserve(x.size());
  for (const double value : x) out.push_back((value - centre) * factor);
  return out;
}

void require_position(const std::string& path, const std::vector<double>& latitude,
                      const std::vector<double>& longitude) {
  for (std::size_t i = 0; i < latitude.size(); ++i) {
    const bool none = latitude[i] == 0.0 && longitude[i] == 0.0;
    if (none || std::abs(latitude[i]) > 90.0 || std::abs(longitude[i]) > 360.0) {
      throw FileError(
          fmt::format("{}: latitude {:g}, longitude {:g} in the stretch is no position; choose a stretch "
                      "where the receiver has one",
                      path, latitude[i], longitude[i]));
    }
  }
}

// Metres per degree of latitude and of longitude.
std::pair<double, double> metres_per_degree(double latitude_deg) {
  constexpr double kEquatorRadius_m = 6378137.0, kEccentricity2 = 6.69437999014e-3;
  const double sine = std::sin(latitude_deg * kRadPerDeg);
  const double w2 = 1.0 - kEccentricity2 * sine * sine;
  const double across = kEquatorRadius_m / std::sqrt(w2);
  const double along = across * (1.0 - kEccentricity2) / w2;
  return {along * kRadPerDeg, across * std::cos(latitude_deg * kRadPerDeg) * kRadPerDeg};
}

bool in_feet(const std::string& name) {
  const std::size_t bracket = name.find('(');
  return bracket != std::string::npos && name.find("feet", bracket) != std::string::npos;
}

// All axes exactly zero: the sensor had no value yet. The neighbouring value is used.
std::size_t replace_unmeasured(std::vector<double>& x, std::vector<double>& y, std::vector<double>& z) {
  const auto missing = [&](std::size_t i) { return x[i] == 0.0 && y[i] == 0.0 && z[i] == 0.0; };
  std::size_t n = 0, good = 0;
  while (good < x.size() && missing(good)) ++good;
  if (good == x.size()) return x.size();
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!missing(i)) {
      good = i;
      continue;
    }
    x[i] = x[good], y[i] = y[good], z[i] = z[good];
    ++n;
  }
  return n;
}

}  // namespace

core::FlightPath read_flight_path(const std::string& path, double from_s, double to_s) {
  TimedColumnsWish wish;
  wish.time = {{"time"}, "milliseconds since the start", 0.0};
  wish.seconds_per_unit = 1e-3;
  wish.columns = {{{"latitude"}, "degrees", 0.0},
                  {{"longitude"}, "degrees", 0.0},
                  {{"altitude_above_seaLevel", "altitude"}, "height of the position solution", 0.0},
                  {{"compass_heading"}, "degrees clockwise from north", 360.0}};
  wish.from_s = from_s;
  wish.to_s = to_s;
  const TimedColumns table = read_timed_columns(path, wish);
  require_position(path, table.columns[0], table.columns[1]);
  const auto [per_latitude_m, per_longitude_m] = metres_per_degree(mean(table.columns[0]));
  core::FlightPath out;
  out.rate_hz = table.rate_hz;
  out.from_s = table.from_s;
  out.north_mm = about_mean(table.columns[0], 1e3 * per_latitude_m);
  out.east_mm = about_mean(table.columns[1], 1e3 * per_longitude_m);
  out.up_mm = about_mean(table.columns[2], 1e3 * (in_feet(table.names[2]) ? kMetresPerFoot : 1.0));
  const double heading_deg = mean(table.columns[3]);
  out.mean_heading_deg = heading_deg - 360.0 * std::floor(heading_deg / 360.0);
  return out;
}

core::FlightAttitude read_flight_attitude(const std::string& path, double first_row_at_s, double from_s, double to_s) {
  TimedColumnsWish wish;
  wish.time = {{"SampleTimeFine"}, "microseconds", 0.0};
  wish.seconds_per_unit = 1e-6;
  wish.first_row_is_zero = true;
  wish.offset_s = first_row_at_s;
  for (const char* name : {"Euler_X", "Euler_Y", "Euler_Z"}) wish.columns.push_back({{name}, "degrees", 360.0});
  for (const char* name : {"Acc_X", "Acc_Y", "Acc_Z"}) wish.columns.push_back({{name}, "m/s^2", 0.0});
  wish.from_s = from_s;
  wish.to_s = to_s;
  TimedColumns table = read_timed_columns(path, wish);
  core::FlightAttitude out;
  out.rate_hz = table.rate_hz;
  out.from_s = table.from_s;
  const std::vector<double>&roll = table.columns[0], &pitch = table.columns[1], &yaw = table.columns[2];
  out.mean_roll_rad = kRadPerDeg * mean(roll);
  out.mean_pitch_rad = kRadPerDeg * mean(pitch);
  out.mean_yaw_rad = kRadPerDeg * mean(yaw);
  out.roll_rad = about_mean(roll, kRadPerDeg);
  out.pitch_rad = about_mean(pitch, kRadPerDeg);
  out.yaw_rad = about_mean(yaw, kRadPerDeg);
  out.n_replaced = replace_unmeasured(table.columns[3], table.columns[4], table.columns[5]);
  if (out.n_replaced == out.roll_rad.size())
    throw FileError(fmt::format("{}: all accelerations of the stretch are zero; choose another one", path));
  out.x_m_s2 = std::move(table.columns[3]);
  out.y_m_s2 = std::move(table.columns[4]);
  out.z_m_s2 = std::move(table.columns[5]);
  return out;
}

}  // namespace drivers
