#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/identification/combine_estimates.h"
#include "firmware_app/report/modal_json.h"
#include "tools/hovermodal/batch/flight_order.h"
#include "tools/hovermodal/batch/inventory.h"

namespace tools {

struct FlightResult {
  std::string name;
  FlightKind kind = FlightKind::kRecord;
  std::string failure;        // empty: the flight is part of the result
  std::string contradiction;  // its frequencies against those of all others; not empty: it is left out of them
  std::size_t i_view = 0;     // into BatchResult::views
  app::ModalReport report;    // as its modal.json
};

// Flights whose sums may be added, and the one estimate of all of them.
struct ViewResult {
  std::vector<std::size_t> flights;
  std::string why;          // why it differs from the first view; empty: it is the first
  app::ModalReport report;  // for a single flight: its own
};

struct BatchMode {
  core::WeightedMean frequency_hz, damping_ratio;  // of all views; n = 0: found in single flights only
  struct Of {
    std::size_t index = 0;  // of a flight, or of a view
    std::size_t i_mode = 0;
  };
  std::vector<Of> flights, views;
  core::WeightedMean flights_frequency_hz, flights_damping_ratio;  // inverse variance of single flights, as a check
};

struct BatchResult {
  std::vector<FlightResult> flights;  // by name
  std::vector<ViewResult> views;
  std::vector<BatchMode> modes;      // modes found in all, by frequency
  std::vector<BatchMode> unsettled;  // found in single flights, but not in the sums of their view
};

// Reads the results of the flights from their folders, one at a time and in their order; failures: of each, "" = none.
// Flights of one view are added and identified together; estimates of different views are combined by inverse variance.
// A flight whose results cannot be read, or whose samples equal those of an earlier one, fails. A flight that
// contradicts the others (contradicting_flights.h) is left out. Depends only on the flights' results and order.
[[nodiscard]] BatchResult combine_flights(const std::vector<FlightOrder>& orders,
                                          const std::vector<std::string>& failures);

[[nodiscard]] std::string batch_json(const BatchResult& result);
[[nodiscard]] std::string batch_text(const BatchResult& result);
[[nodiscard]] std::string batch_svg(const BatchResult& result);  // empty: no mode

}  // namespace tools
