#pragma once

#include <limits>
#include <string>
#include <vector>

#include "firmware_app/report/modal_json.h"

namespace tools {

// One flight of many over months, with its modes.
struct DatedFlight {
  std::string name;
  std::string date;                                                 // as given; empty: only the order is known
  double day = 0.0;                                                 // from any zero
  double temperature_c = std::numeric_limits<double>::quiet_NaN();  // NaN: not given
  app::ModalReport report = {};                                     // without the poles of single orders
};

// In the order of time. `path` is
//   a table (CSV) with a line per flight and the columns report (modal.json, or the folder with it; relative to the
//   table), date (YYYY-MM-DD or YYYY-MM-DDTHH:MM) or day (a number), and, if known, temperature_c;
//   or a folder with a folder for each flight, in the order of their names and one day apart.
// Throws drivers::FileError naming file, line, column and remedy.
[[nodiscard]] std::vector<DatedFlight> read_flights(const std::string& path);

}  // namespace tools
