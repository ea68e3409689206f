#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/structure/declared_frame.h"
#include "core/types/loop_progress.h"
#include "core/types/loop_result.h"
#include "firmware_app/config/config.h"

namespace app {

// A finished run as its report folder contains it, and further known facts.
struct LevelLoopInputs {
  std::string folder;  // displacements.csv or tracks.csv; modal.json states the source of the frames' times
  std::optional<AppConfig> config;      // of the run: required by the observation level
  std::vector<std::string> bases = {};  // base channels, where no configuration names them
  std::optional<core::structure::DeclaredFrame> structure = {};
  std::vector<double> reference_hz = {};  // modes known from other sources
  double max_frequency_hz = 0.0;
  std::size_t n_surrogates = 64;
  std::uint64_t seed = 1;
  core::closure::TellProgress progress = {};
  // Frames times points, or times channels, that a level goes through: of a longer record its end. A cell takes up to
  // 2 kB.
  std::size_t most_cells = 600'000;
};

// Clock and frames -> observation -> response -> structure if declared, each on the data corrected by the level before;
// then the modes before any correction and after the last, against the reference or the halves of the record. Memory
// and time grow with the record up to most_cells: about half a minute for 120 s and 70 points. One thread; the same
// input gives the same result. Throws drivers::FileError if the folder contains no record, std::invalid_argument.
[[nodiscard]] core::closure::LoopResult close_levels(const LevelLoopInputs& inputs);

}  // namespace app
