#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/monitoring/change_test.h"
#include "core/monitoring/contradicting_flights.h"
#include "tools/hovermodal/changes/flight_list.h"

namespace tools {

// A quantity over the flights, and the test of it.
struct History {
  core::monitoring::FlightSeries values;
  core::monitoring::Change change;
};

struct ModeHistory {
  History frequency;    // Hz
  History log_damping;  // natural logarithm of the ratio
  struct Component {
    std::string channel;
    History value;  // of the shape, scaled so that its projection on the mean shape is 1
  };
  std::vector<Component> shape;  // of the channels that all of the mode's flights have

  [[nodiscard]] bool is_changed() const noexcept;
};

// Chance of a false report over all modes of a structure that did not change: 0.7 % in all.
struct ChangeLevels {
  static constexpr double kFrequency = 0.004, kDamping = 0.0015, kShape = 0.0015;
};

struct ModeHistories {
  std::vector<DatedFlight> flights;
  std::vector<core::monitoring::ContradictingFlight> contradicting;  // are in no series
  std::vector<ModeHistory> modes;  // found in at least a third of the flights and in two, by frequency
  std::size_t n_rare = 0;          // modes found in fewer
  bool knows_temperature = false;  // of at least kLeastFlights flights

  [[nodiscard]] bool is_changed() const noexcept;
};

// Modes are matched by frequency and shape (combine_estimates.h). A mode that ends where one of the same shape (MAC
// 0.9) begins within 20 % of its frequency goes on as that one. Values without a standard deviation are not tested.
[[nodiscard]] ModeHistories find_changes(std::vector<DatedFlight> flights);

[[nodiscard]] std::string changes_text(const ModeHistories& result);
[[nodiscard]] std::string changes_json(const ModeHistories& result);
[[nodiscard]] std::string changes_svg(const ModeHistories& result);  // empty: no mode

}  // namespace tools
