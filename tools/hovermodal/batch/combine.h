#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/identification/combine_estimates.h"
#include "firmware_app/report/modal_json.h"
#include "tools/hovermodal/batch/inventory.h"

namespace tools {

struct FlightResult {
  std::string name;
  FlightKind kind = FlightKind::kRecord;
  std::string failure;      // empty: it is part of the result
  std::size_t i_view = 0;   // into BatchResult::views
  app::ModalReport report;  // as its modal.json
};

// Flights whose sums may be added, and the one estimate of all of them.
struct ViewResult {
  std::vector<std::size_t> flights;
  std::string why;          // why it is not the first view; empty: it is
  app::ModalReport report;  // of a single flight: its own
};

struct BatchMode {
  core::WeightedMean frequency_hz, damping_ratio;  // of all views; n = 0: only single flights show it
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
  std::vector<BatchMode> modes;      // by frequency
  std::vector<BatchMode> unsettled;  // of single flights, which the sums of their view do not show
};

// Reads what the flights left in `folders`, in the order of `flights`, one at a time. Flights of one view are added and
// identified together; what their views say is combined by inverse variance. A flight whose results cannot be read, or
// which holds the samples of one before it, fails. A function of the flights' results and order alone.
[[nodiscard]] BatchResult combine_flights(std::vector<FlightResult> flights, const std::vector<std::string>& folders);

[[nodiscard]] std::string batch_json(const BatchResult& result);
[[nodiscard]] std::string batch_text(const BatchResult& result);
[[nodiscard]] std::string batch_svg(const BatchResult& result);  // empty: there is no mode

}  // namespace tools
