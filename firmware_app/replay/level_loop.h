#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/structure/declared_frame.h"
#include "core/types/loop_result.h"
#include "firmware_app/config/config.h"

namespace app {

// A finished run, as its report folder holds it, and what is known besides.
struct LevelLoopInputs {
  std::string folder;  // displacements.csv or tracks.csv; modal.json says where the frames' times come from
  std::optional<AppConfig> config;                           // of the run: what the observation level needs
  std::vector<std::string> bases = {};                       // base channels where no configuration says so
  std::optional<core::structure::DeclaredFrame> structure = {};
  std::vector<double> reference_hz = {};  // modes known from elsewhere
  double max_frequency_hz = 0.0;
  std::size_t n_surrogates = 64;
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> progress = {};
};

// Clock and frames -> observation -> response -> structure where one is declared, each on what the one before repaired;
// then the modes before any repair and after the last, against the reference, or the halves of the record. Memory and
// time grow with the record: about half a minute for 120 s and 70 points. One thread; the same input gives the same
// result. Throws drivers::FileError where the folder holds no record, std::invalid_argument.
[[nodiscard]] core::closure::LoopResult close_levels(const LevelLoopInputs& inputs);

}  // namespace app
