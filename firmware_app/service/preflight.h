#pragma once

#include <string>
#include <vector>

#include "firmware_app/config/config.h"
#include "firmware_app/service/source.h"

namespace app {

struct RegionCheck {
  std::string name;
  std::string axis;                      // "-": static; with "found" if estimated from the motion
  std::size_t n_seeded = 0, n_seen = 0;  // n_seen: found in nearly all of the frames tried
  double point_sigma_px = 0.0;           // median over its points; 0 = none was seen
  double noise_px = 0.0;                 // expected rms of one displacement of the region
  double mm_per_px = 0.0;                // 0 = unknown
};

struct Preflight {
  std::vector<RegionCheck> regions;
  std::vector<std::string> facts;     // scale, times, readout, exposure: one line each
  std::vector<std::string> warnings;  // doubtful values, with the likely mistake
};

// Tracks at most the first second of the source, which is consumed up to there.
[[nodiscard]] Preflight preflight(const AppConfig& config, Source& source);
[[nodiscard]] std::string preflight_text(const Preflight& found);  // the table of --check

}  // namespace app
