#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/identification/combine_estimates.h"
#include "core/monitoring/change_test.h"
#include "core/monitoring/contradicting_flights.h"
#include "firmware_app/report/modal_json.h"

namespace tools {

// The modes of one structure in several flights.
struct MatchedFlights {
  std::vector<std::vector<core::ModePlace>>
      modes;               // of the others; found in at least a third of the flights and in two
  std::size_t n_rare = 0;  // modes found in fewer
  std::vector<core::monitoring::ContradictingFlight> contradicting;  // are in no mode
};

// Modes are matched by frequency and shape (combine_estimates.h). A mode that ends where one of the same shape (MAC
// 0.9) begins within 20 % of its frequency goes on as that one. A flight contradicts the others as
// contradicting_flights.h states, or if none of its modes is theirs while its shapes are, all by one ratio of the
// frequencies (a frame rate of 25 stated for 30). `reports`: in the order of time, borrowed; conditions: of each.
[[nodiscard]] MatchedFlights match_flights(const std::vector<const app::ModalReport*>& reports,
                                           const core::monitoring::Conditions& conditions);

// "all its 5 modes lie 1.02 % +- 0.05 % higher: check its frame rate or clock"
[[nodiscard]] std::string words_of(const core::monitoring::ContradictingFlight& flight);

// Of one mode; without those that state no standard deviation.
[[nodiscard]] core::monitoring::FlightSeries frequencies_of(const std::vector<const app::ModalReport*>& reports,
                                                            const std::vector<core::ModePlace>& mode);

}  // namespace tools
