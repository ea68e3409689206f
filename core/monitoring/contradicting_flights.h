#pragma once

#include <cstddef>
#include <vector>

#include "core/monitoring/change_test.h"

namespace core::monitoring {

// A flight whose frequencies differ from those of all other flights by one common factor: its clock or its stated frame
// rate is wrong, or the structure was another one that day.
struct ContradictingFlight {
  std::size_t flight = 0;
  double share = 0.0, std = 0.0;  // its frequencies over those of the others, minus 1
  std::size_t n_modes = 0;        // that it shares with the others
  bool is_common = false;         // all its modes differ by that share (two or more modes): a clock does that
};

// A flight's share is the inverse-variance mean over its modes of log(f / median of all flights' f). Leave-one-out:
// each share against the one that the other flights predict (their mean; with known temperatures of at least six
// flights, a line over the temperature), with its own standard deviation, that of the prediction, and the scatter of
// the others beyond what they state. So of three flights the one with a wrong clock is found and not its neighbours,
// and weather that moves all modes alike is none. The worst flight is removed and the rest is compared again, until
// none differs by more than chance (four standard deviations of a normal distribution, as rare in Student's t) and 0.1
// %, or two flights or two thirds of them remain. A flight whose neighbour in time differs likewise does not
// contradict: the structure changed. modes: frequencies of one mode each, > 0. Ordered by flight.
[[nodiscard]] std::vector<ContradictingFlight> contradicting_flights(const std::vector<FlightSeries>& modes,
                                                                     const Conditions& conditions);

}  // namespace core::monitoring
