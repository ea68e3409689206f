#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "tools/validate/geometry_flight.h"

namespace tools {

// kColoured: the ground's own spectrum has one or two peaks, drawn, at least 6 % from every mode.
enum class Drive : std::uint8_t { kTable, kColoured, kWind };
inline constexpr std::array kDrives{Drive::kTable, Drive::kColoured, Drive::kWind};
[[nodiscard]] const char* word_for(Drive drive) noexcept;

// What else happens to a record. kLosses: 10 ... 30 % of the frames, drawn, are lost at random. kVibration: the camera
// shakes and turns (trust_shaking.h), and nothing declares it.
enum class Disturbance : std::uint8_t { kNone, kLosses, kVibration };
[[nodiscard]] const char* word_for(Disturbance disturbance) noexcept;

// The paper's experiment at 25 fps with a readout of 0.4 ... 1 frame, moved by the hover of foreign_scene.h.
struct TrustFlight {
  SimulateJob job;
  FlightSetup setup;
  std::string hover;  // "recorded" or "tails"
};
[[nodiscard]] TrustFlight trust_flight(Drive drive, std::uint64_t seed, double duration_s,
                                       const GeometryOptions& options);

}  // namespace tools
