#pragma once

#include <string>
#include <vector>

#include "drivers/exchange/exchange_run.h"

namespace tools {

// A run's folder for other programs, and what its files do not say.
struct LoadedRun {
  drivers::ExchangeRun run;
  std::vector<std::string> remarks;
};

// Reads modal.json, and displacements.csv and tracks.csv where they are. Spectra and correlations are computed from
// displacements.csv with the run's segment. `path`: the folder, or its modal.json. Throws drivers::FileError naming the
// file, std::invalid_argument if the folder has no modal.json.
[[nodiscard]] LoadedRun load_run(const std::string& path);

}  // namespace tools
