#pragma once

#include <string>

namespace tools {

// Flights over two years past one structure, as `hovermodal changes` reads them: a folder for each seed in `folder`,
// with flights.csv and a modal.json for each flight. Structure, dates and temperatures are drawn from the seed. Every
// flight is a record of two minutes of its own that is identified.
struct ChangesOptions {
  int n_seeds = 20, n_threads = 2, first_seed = 1;
  double loss = 0.0;  // share of one storey's stiffness, from flight 16 of 30 on
  std::string folder;
};
void write_changing_flights(const ChangesOptions& options);
// Three flights within a week; the clock of one is wrong by 0.5 to 20 %. Prints the seed and the wrong flight.
void write_clock_flights(const ChangesOptions& options);

}  // namespace tools
